// The runs on one recording beside each other.
import {lengthText, run as loadRun, scaled} from './data.js';
import {el, figure} from './dom.js';
import {pathPlot, startKey} from './paths.js';
import {planar} from './run_view.js';
import {seriesChart} from './series.js';
import {kind} from './theme.js';

/** Of each variant its first run. */
export function representatives(report, recording) {
  const seen = new Set(), list = [];
  report.runs.forEach((run, index) => {
    if (run.recording !== recording) return;
    if (seen.has(run.variant)) return;
    seen.add(run.variant);
    list.push({variant: run.variant, index});
  });
  return list;
}

const most = 8;  // lines that a picture can hold

/** Errors over the times of all runs: null before a pose behind a gap, undefined at the times of other runs. */
function errorsOf(runs) {
  const of = runs.map(({run: {trace}}) => new Map(trace.t.flatMap((ms, i) => (
    trace.gap[i] ? [[ms - 1, null], [ms, 0.1 * trace.e[i]]] : [[ms, 0.1 * trace.e[i]]]))));
  const all = [...new Set(of.flatMap(errors => [...errors.keys()]))].sort((a, b) => a - b);
  return [scaled(all, 1e-3), ...of.map(errors => all.map(ms => errors.get(ms)))];
}

export async function recordingView(report, recording) {
  const all = representatives(report, recording), chosen = all.slice(0, most);
  const runs = (await Promise.all(chosen.map(async c => ({...c, run: await loadRun(c.index)}))))
    .filter(r => r.run.trace.truth && r.run.trace.t.length);
  if (!runs.length) return el('p', {class: 'quiet'}, 'No run on this recording can be compared with a truth.');
  const truth = runs.reduce((a, b) => b.run.trace.t.length > a.run.trace.t.length ? b : a).run.trace;
  const lines = (a, b) => [planar(truth, 'truth', a, b), ...runs.map((r, i) => (
    {...planar(r.run.trace, 'estimate', a, b), error: undefined, colour: kind(i)}))];
  const legend = el('div', {class: 'legend'}, ...runs.map((r, i) => el('span', {},
    el('i', {style: `background:${kind(i)}`}), `${r.variant}: ATE ${lengthText(r.run.errors.ate_m[0])}`)),
    el('span', {}, el('i', {class: 'truth-key'}), 'truth'), startKey());
  const several = report.runs.filter(run => run.recording === recording).length > all.length;
  const what = [several ? 'The first run of each variant.' : '',
                all.length > most ? `The first ${most} of ${all.length} variants are drawn.` : ''].filter(Boolean);
  const note = what.length ? el('p', {class: 'quiet'}, what.join(' ')) : null;
  return el('div', {}, legend, note, el('div', {class: 'pair'},
    figure('x–y', pathPlot(lines(0, 1), true, 'x [m]', 'y [m]')),
    figure('x–z', pathPlot(lines(0, 2), true, 'x [m]', 'z [m]'))),
    figure('Absolute trajectory error', seriesChart(errorsOf(runs), runs.map((r, i) => (
      {label: r.variant, colour: kind(i)})), {height: 220, xName: 'time [s]', yName: 'ATE [mm]'})));
}
