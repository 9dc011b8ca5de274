// Trajectories with equal scales on both axes.
import {el} from './dom.js';
import {heat} from './theme.js';

const width = 560, height = 380, left = 52, right = 12, top = 10, bottom = 40;

function niceStep(span, count) {
  const raw = span / count, power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].find(m => m * power >= raw) * power;
}

function ticks(low, high, count) {
  const step = niceStep(high - low, count), result = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) result.push(+(k * step).toPrecision(10));
  return result;
}

/** Ranges around all points so that a metre is as long along both axes. */
function scales(paths) {
  const range = axis => {
    const all = paths.flatMap(p => p[axis]);
    const low = all.reduce((a, b) => Math.min(a, b), Infinity);
    const high = all.reduce((a, b) => Math.max(a, b), -Infinity);
    const margin = Math.max(0.05 * (high - low), 0.005);
    return [low - margin, high + margin];
  };
  const x = range('x'), y = range('y');
  const w = width - left - right, h = height - top - bottom;
  const perPixel = Math.max((x[1] - x[0]) / w, (y[1] - y[0]) / h);
  const widen = (r, size) => {
    const missing = (perPixel * size - (r[1] - r[0])) / 2;
    return [r[0] - missing, r[1] + missing];
  };
  const X = widen(x, w), Y = widen(y, h);
  return {X, Y, x: v => left + (v - X[0]) / perPixel, y: v => height - bottom - (v - Y[0]) / perPixel};
}

function axes(s, xName, yName) {
  const parts = [];
  for (const v of ticks(...s.X, 6))
    parts.push(el('line', {x1: s.x(v), x2: s.x(v), y1: top, y2: height - bottom, class: 'grid'}),
               el('text', {x: s.x(v), y: height - bottom + 15, class: 'tick middle'}, String(v)));
  for (const v of ticks(...s.Y, 5))
    parts.push(el('line', {y1: s.y(v), y2: s.y(v), x1: left, x2: width - right, class: 'grid'}),
               el('text', {x: left - 6, y: s.y(v) + 4, class: 'tick end'}, String(v)));
  parts.push(el('text', {x: (left + width - right) / 2, y: height - 6, class: 'axis middle'}, xName),
             el('text', {x: 14, y: (top + height - bottom) / 2, class: 'axis middle',
                         transform: `rotate(-90 14 ${(top + height - bottom) / 2})`}, yName));
  return parts;
}

function lineOf(s, path, from = 0, to = path.x.length - 1) {
  let d = '';
  for (let i = from; i <= to; ++i)
    d += `${i === from || path.gap?.[i] ? 'M' : 'L'}${s.x(path.x[i]).toFixed(1)} ${s.y(path.y[i]).toFixed(1)}`;
  return d;
}

/** Segments of about the same error share a path element. */
function colouredLines(s, path, largest) {
  const buckets = 24, lines = new Array(buckets).fill('');
  for (let i = 1; i < path.x.length; ++i) {
    if (path.gap[i]) continue;
    const error = (path.error[i - 1] + path.error[i]) / 2;
    lines[Math.min(buckets - 1, Math.floor(buckets * error / largest))] += lineOf(s, path, i - 1, i);
  }
  return lines.map((d, k) => d && el('path', {d, class: 'line coloured',
                                               stroke: heat((k + 0.5) / buckets)})).filter(Boolean);
}

/**
 * paths: [{x, y, gap, error?, colour?, name?}], metres; the first is the truth where `hasTruth`.
 * With `error`, a line is coloured by it, `largest` being the end of the scale.
 */
export function pathPlot(paths, hasTruth, xName, yName, largest) {
  const s = scales(paths);
  const parts = axes(s, xName, yName);
  paths.forEach((path, i) => {
    if (hasTruth && i === 0) parts.push(el('path', {d: lineOf(s, path), class: 'line truth'}));
    else if (path.error) parts.push(...colouredLines(s, path, largest));
    else parts.push(el('path', {d: lineOf(s, path), class: 'line', stroke: path.colour}));
  });
  parts.push(el('circle', {cx: s.x(paths[0].x[0]), cy: s.y(paths[0].y[0]), r: 4, class: 'begin'}));
  return el('svg', {viewBox: `0 0 ${width} ${height}`, class: 'path', role: 'img'}, ...parts);
}

/** Part of a legend: where the first path begins. */
export const startKey = () => el('span', {}, el('i', {class: 'start-key'}), 'start');

/** Colours of errors from 0 to `largest`, metres. */
export function colourBar(largest) {
  const stops = [0, 0.25, 0.5, 0.75, 1].map(heat).join(',');
  return el('div', {class: 'bar-legend'}, el('span', {}, 'absolute error: 0'),
            el('span', {class: 'ramp', style: `background:linear-gradient(90deg,${stops})`}),
            el('span', {}, `${(1000 * largest).toPrecision(3)} mm`),
            el('span', {class: 'key truth-key'}), el('span', {}, 'truth'),
            el('span', {class: 'key start-key'}), el('span', {}, 'start'));
}
