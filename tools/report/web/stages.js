// Time per stage: stacked over the recording, percentiles, and runs beside each other.
import {el, figure} from './dom.js';
import {seriesChart} from './series.js';
import {scaled} from './data.js';
import {kind} from './theme.js';
import {figureCell, table} from './tables.js';

/** Waiting, and what contains other stages, would count twice. */
const counts = name => !name.endsWith('_wait') && name !== 'track_thread';

const order = [];
/** The same stage has the same colour everywhere. */
function colourOf(name) {
  if (!order.includes(name)) order.push(name);
  return kind(order.indexOf(name));
}

const tinted = colour => colour + '99';

function stackedChart(stages) {
  const list = stages.list.filter(s => counts(s.name));
  const x = Array.from({length: stages.parts}, (_, i) => (i + 0.5) * stages.frames / stages.parts);
  let sum = new Array(stages.parts).fill(0);
  const stacked = list.map(s => {
    const own = scaled(s.cpu_ms, 0.01);
    sum = sum.map((v, i) => v + own[i]);
    return {name: s.name, own, sum};
  }).reverse();  // uPlot draws the first one at the back
  return seriesChart([x, ...stacked.map(s => s.sum)], stacked.map(s => ({
    label: s.name, colour: colourOf(s.name), fill: tinted(colourOf(s.name)), width: 1,
    value: (_, v, __, i) => i === null || v === null ? '–' : s.own[i].toFixed(1)})),
    {height: 240, xName: 'frame', yName: 'CPU [ms/frame]',
     bands: stacked.slice(1).map((_, i) => ({series: [i + 1, i + 2]}))});
}

/** "Feature extraction (prepare)" */
const titled = (name, title) => title ? `${title} (${name})` : name;

function percentiles(stages) {
  return table({header: ['stage', 'calls', 'mean', 'median', 'p95', 'p99', 'max', 'CPU, mean'],
    rows: stages.list.map(s => [{t: titled(s.name, s.title)}, {t: String(s.calls), v: s.calls},
                                ...s.wall.map(v => figureCell(v, 2)), figureCell(s.cpu[0], 2)])});
}

export function stageFigures(run) {
  if (!run.stages.list.length) return [el('p', {class: 'quiet'}, 'The run has no timings.csv.')];
  return [figure('CPU time per frame by stage, of all threads', stackedChart(run.stages)),
          figure('Time of single calls (ms): wall clock, and mean CPU time', percentiles(run.stages))];
}

/**
 * rows: [{name, stages: [[stage, ms]]}], mean CPU per frame, as bars beside each other; titles: of the stages by their
 * names.
 */
export function stageBars(rows, titles) {
  const kept = rows.map(r => ({name: r.name, stages: r.stages.filter(([name]) => counts(name))}))
                   .filter(r => r.stages.length);
  const total = r => r.stages.reduce((sum, [, ms]) => sum + ms, 0);
  const largest = Math.max(...kept.map(total));
  const names = [...new Set(kept.flatMap(r => r.stages.map(([name]) => name)))];
  const bars = kept.map(r => el('div', {class: 'bar-row'}, el('span', {class: 'bar-name'}, r.name),
    el('span', {class: 'bar'}, ...r.stages.map(([name, ms]) => el('span', {
      title: `${name}: ${ms.toFixed(2)} ms`,
      style: `width:${100 * ms / largest}%;background:${colourOf(name)}`}))),
    el('span', {class: 'bar-total'}, `${total(r).toFixed(1)} ms`)));
  const legend = el('div', {class: 'legend'}, ...names.map(name => el('span', {},
    el('i', {style: `background:${colourOf(name)}`}), titled(name, titles[name]))));
  return el('div', {class: 'bars'}, ...bars, legend);
}
