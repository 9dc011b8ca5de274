// Figures over frames, and the time of each stage.
import uPlot from 'uplot';

import 'uplot/dist/uPlot.min.css';

const MOST_POINTS = 1500;  // of a series
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Every n-th row, so that a long run is drawn as quickly as a short one. */
function thinned(rows) {
  const every = Math.ceil(rows.length / MOST_POINTS);
  return every <= 1 ? rows : rows.filter((_, i) => i % every === 0);
}

/** Bands of frames that were lost, behind the series. */
function lostBands(run) {
  return (plot) => {
    const {ctx, bbox} = plot;
    ctx.save();
    ctx.fillStyle = '#d0403033';
    for (const [from, to] of run().lostStretches) {
      const left = plot.valToPos(from, 'x', true), right = plot.valToPos(to, 'x', true);
      ctx.fillRect(left, bbox.top, Math.max(1, right - left), bbox.height);
    }
    ctx.restore();
  };
}

class Chart {
  constructor(id, series, run, {zero = true} = {}) {
    this.area = document.getElementById(id);
    const axis = {stroke: () => ink('--quiet'), grid: {stroke: () => ink('--line'), width: 1},
      ticks: {show: false}, font: '11px system-ui'};
    this.plot = new uPlot({
      width: 300, height: 150,
      legend: {show: true, live: true},
      cursor: {drag: {x: false, y: false}, points: {show: false}},
      scales: {x: {time: false}, y: zero ? {range: (_, __, max) => [0, Math.max(max * 1.1, 1e-3)]} : {}},
      axes: [{...axis, size: 24}, {...axis, size: 38}],
      series: [{label: 'frame'}, ...series.map(({label, color}) => ({
        label, stroke: () => ink(color) || color, width: 1.3, points: {show: false},
        value: (_, value) => value == null ? '–' : value.toFixed(value < 10 ? 1 : 0)}))],
      hooks: {drawClear: [lostBands(run)]},
    }, [[], ...series.map(() => [])], this.area);
    new ResizeObserver(() => this.resize()).observe(this.area);
  }
  resize() {
    const legend = this.area.querySelector('.u-legend')?.offsetHeight ?? 24;
    this.plot.setSize({width: this.area.clientWidth, height: Math.max(60, this.area.clientHeight - legend - 2)});
  }
  /** Rows of a frame number and a value per series. */
  set(rows) {
    const kept = thinned(rows);
    this.plot.setData(kept.length ? kept[0].map((_, i) => kept.map((row) => row[i])) : [[], []]);
  }
}

function quantile(sorted, share) { return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))]; }

export class ChartPanel {
  constructor() {
    this.run = {lostStretches: []};
    const run = () => this.run;
    this.times = new Chart('times', [{label: 'tracking', color: '--accent'}], run);
    this.features = new Chart('features', [
      {label: 'extracted', color: '--quiet'}, {label: 'matched', color: '#3d84d6'}, {label: 'fit', color: '--good'}], run);
    this.stages = document.getElementById('stages');
    this.last = null;
  }

  reset() {
    this.last?.plot.destroy();
    this.last = null;
  }

  show(run) {
    this.run = Object.assign(Object.create(run), {lostStretches: this.lostStretches(run)});
    this.times.set(run.tracking.map(({frame, ms}) => [frame, ms]));
    this.features.set(run.frames.map((f) => [f.index, f.features, f.matches, f.inliers]));
    this.showLast(run);
    this.showStages(run);
  }

  lostStretches(run) {
    const stretches = [];
    for (const {index, state} of run.frames) {
      if (state !== 'lost') continue;
      const last = stretches.at(-1);
      if (last && index - last[1] <= 2) last[1] = index;
      else stretches.push([index, index]);
    }
    return stretches;
  }

  // The error where there is a truth; otherwise how fast the camera moves.
  showLast(run) {
    const error = run.hello.truth;
    if (!this.last) {
      document.getElementById('last-title').innerHTML = error
        ? 'Distance from the truth <small>cm, after alignment</small>'
        : 'Speed of the camera <small>m/s</small>';
      this.last = new Chart('last', [error ? {label: 'error', color: '#d55e00'} : {label: 'speed', color: '#3d84d6'}],
        () => this.run);
      this.last.resize();
    }
    this.last.set(error
      ? run.frames.map((frame) => { const e = run.errorOf(frame); return [frame.index, e === null ? null : 100 * e]; })
      : this.speeds(run));
  }

  speeds(run) {
    const step = 5;  // frames, to even out noise
    return run.frames.slice(step).map((frame, i) => {
      const before = run.frames[i];
      if (frame.state !== 'tracking' || before.state !== 'tracking') return [frame.index, null];
      const [a, b] = [run.positionOf(before), run.positionOf(frame)];
      return [frame.index, Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / (frame.time - before.time)];
    });
  }

  showStages(run) {
    const rows = run.stages.map((name, i) => {
      const sorted = [...run.times[i]].sort((a, b) => a - b);
      return {name, median: quantile(sorted, 0.5) ?? 0, high: quantile(sorted, 0.95) ?? 0};
    }).sort((a, b) => b.median - a.median).slice(0, 9);
    const most = Math.max(1, ...rows.map((row) => row.median));
    this.stages.replaceChildren(...rows.map(({name, median, high}) => {
      const row = document.createElement('tr');
      const cell = (text, kind) => {
        const td = row.insertCell();
        td.textContent = text;
        if (kind) td.className = kind;
        return td;
      };
      cell(name);
      cell(median.toFixed(1), 'number');
      cell(high.toFixed(1), 'number');
      const bar = document.createElement('span');
      bar.className = 'stage';
      bar.style.width = `${Math.round(70 * median / most)}px`;
      cell('').append(bar);
      return row;
    }));
  }
}
