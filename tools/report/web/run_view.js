// Everything about one run.
import {lengthText, scaled} from './data.js';
import {el, figure, section} from './dom.js';
import {frameGrid} from './frames.js';
import {mapView} from './map.js';
import {optionFigures} from './options.js';
import {colourBar, pathPlot, startKey} from './paths.js';
import {replayView} from './replay.js';
import {seriesChart} from './series.js';
import {stageFigures} from './stages.js';
import {figureCell, table} from './tables.js';
import {kind} from './theme.js';

const mm = 0.001;

/** x and y of the points of a trace, in metres. */
export function planar(trace, which, a, b) {
  return {x: scaled(trace[which][a], mm), y: scaled(trace[which][b], mm), gap: trace.gap,
          error: which === 'estimate' && trace.e ? scaled(trace.e, 1e-4) : undefined};
}

const views = [['x–y', 0, 1, 'x [m]', 'y [m]'], ['x–z', 0, 2, 'x [m]', 'z [m]']];

function trajectoryFigures(run) {
  if (!run.trace.t.length) return [el('p', {class: 'quiet'}, 'No frame was tracked.')];
  if (!run.trace.truth)
    return [el('div', {class: 'pair'}, ...views.map(([title, a, b, x, y]) => figure(title,
      pathPlot([{...planar(run.trace, 'estimate', a, b), colour: kind(0)}], false, x, y)))),
      el('div', {class: 'legend'}, startKey())];
  const largest = Math.max(1e-4, ...scaled(run.trace.e, 1e-4));
  return [el('div', {class: 'pair'}, ...views.map(([title, a, b, x, y]) => figure(title, pathPlot(
    [planar(run.trace, 'truth', a, b), planar(run.trace, 'estimate', a, b)], true, x, y, largest)))),
    colourBar(largest)];
}

/** Breaks the line where frames without a pose lie in between. */
function withGaps(t, gap, ...columns) {
  const x = [], ys = columns.map(() => []);
  t.forEach((seconds, i) => {
    if (gap?.[i]) { x.push(seconds - 1e-6); ys.forEach(y => y.push(null)); }
    x.push(seconds);
    ys.forEach((y, k) => y.push(columns[k][i]));
  });
  return [x, ...ys];
}

function timeFigures(run) {
  const common = {xName: 'time [s]', lost: run.lost, loops: run.loops, sync: run.name};
  const parts = [];
  if (run.trace.e)
    parts.push(figure('Absolute trajectory error', seriesChart(
      withGaps(scaled(run.trace.t, 1e-3), run.trace.gap, scaled(run.trace.e, 0.1)),
      [{label: 'ATE [mm]', colour: kind(0)}], {...common, yName: 'ATE [mm]'})));
  const drifted = scaled(run.drift.t, 1e-3);
  if (drifted.length)
    parts.push(figure('Relative pose error over the next second', seriesChart(
      withGaps(drifted, behindLost(drifted, run.lost), scaled(run.drift.m, 0.1), scaled(run.drift.deg, 1e-3)),
      [{label: 'position [mm]', colour: kind(0)},
       {label: 'rotation [deg]', colour: kind(1), scale: 'y2', digits: 3}],
      {...common, yName: 'position [mm]', y2Name: 'rotation [deg]'})));
  if (run.frames.t.length) {
    const t = scaled(run.frames.t, 1e-3);
    parts.push(figure('Pixels that tracking does not use, and moving points', seriesChart(
      [t, scaled(run.frames.excluded, 0.1), run.frames.moving],
      [{label: 'excluded [%]', colour: kind(1), fill: kind(1) + '40'},
       {label: 'moving points', colour: kind(3), scale: 'y2', digits: 0}],
      {...common, yName: 'excluded [%]', y2Name: 'moving points'})));
    parts.push(figure('Features', seriesChart(
      [t, run.frames.features, run.frames.matches, run.frames.inliers],
      [{label: 'extracted', colour: kind(9), digits: 0}, {label: 'matched', colour: kind(5), digits: 0},
       {label: 'inliers', colour: kind(2), digits: 0}], {...common, yName: 'features'})));
  }
  if (!parts.length) return [];
  const legend = el('div', {class: 'legend'},
    run.lost.length ? el('span', {}, el('i', {class: 'lost-key'}), 'no pose') : null,
    run.loops.length ? el('span', {}, el('i', {class: 'loop-key'}), 'loop closed') : null);
  return [legend, el('div', {class: 'pair'}, ...parts)];
}

/** Which of the moments is the first one behind a lost stretch. */
function behindLost(t, lost) {
  return t.map((seconds, i) => i > 0 && lost.some(([begin]) => t[i - 1] < begin && begin <= seconds));
}

const facts = [['coverage', v => `${(100 * v).toFixed(1)} %`, 'coverage'], ['frames', v => v, 'frames'],
  ['times_lost', v => v, 'times lost'], ['loops', v => v, 'loops closed'], ['keyframes', v => v, 'key frames'],
  ['speed', v => v.toFixed(1), 'frames/s'], ['cpu', v => `${v.toFixed(1)} ms`, 'CPU per frame'],
  ['memory', v => `${v.toFixed(0)} MiB`, 'peak memory']];

function headline(run) {
  const tiles = [];
  const tile = (value, label) => tiles.push(el('div', {class: 'tile'}, el('b', {}, String(value)), label));
  if (run.errors) {
    tile(lengthText(run.errors.ate_m[0]), 'ATE');
    if (run.errors.rpe_m) tile(lengthText(run.errors.rpe_m[0]), 'RPE over 1 s');
  }
  for (const [key, text, label] of facts)
    if (run.facts[key] !== null) tile(text(run.facts[key]), label);
  return el('div', {class: 'tiles'}, ...tiles);
}

function errorTable(errors) {
  const rows = [['ATE, position (mm)', errors.ate_m, 1000], ['ATE, rotation (deg)', errors.ate_deg, 1],
                ['RPE 1 s, position (mm)', errors.rpe_m, 1000], ['RPE 1 s, rotation (deg)', errors.rpe_deg, 1]];
  return table({header: ['error', 'RMSE', 'mean', 'median', 'S.D.', 'min', 'max'],
    rows: rows.filter(([, values]) => values).map(([name, values, factor]) => [{t: name},
      ...values.map(v => figureCell(factor * v, factor > 1 ? 2 : 3))])});
}

function notesOf(run) {
  const list = [...run.notes, ...(run.left_out ?? [])];
  return list.length ? el('div', {class: 'warning'}, ...list.map(note => el('p', {}, note))) : null;
}

export async function runView(run) {
  const parts = [notesOf(run), headline(run), section('Trajectory', ...trajectoryFigures(run),
                                                      run.errors ? errorTable(run.errors) : null)];
  const overTime = timeFigures(run);
  if (overTime.length) parts.push(section('Over time', ...overTime));
  parts.push(section('Time per stage', ...stageFigures(run)));
  if (run.pictures.length) parts.push(section('Frames', run.pictures.every(p => p.recorded) ? null
    : el('p', {class: 'quiet'}, 'Green: features that fit the pose; yellow: that do not; orange: moving; grey: '
    + 'unmatched. Blue: labelled, but used; red: not used. A click enlarges.'), frameGrid(run)));
  const maps = [run.map && await mapView(run.map, run.path), run.replay && replayView(run.replay)].filter(Boolean);
  if (maps.length) parts.push(section('Map', ...maps));
  parts.push(section('Options', ...optionFigures(run)));
  parts.push(el('p', {class: 'quiet'}, `${run.folder}${run.made_by ? ' · ' + run.made_by : ''}`));
  return el('div', {class: 'run'}, ...parts.filter(Boolean));
}
