// Figures over time, drawn by uPlot.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';

import {el} from './dom.js';
import {css, redrawn} from './theme.js';

/** Shades lost stretches and marks loops, behind the lines. */
function events(lost, loops) {
  return {hooks: {drawClear: chart => {
    const {ctx, bbox} = chart;
    const at = seconds => chart.valToPos(seconds, 'x', true);
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = css('--lost');
    for (const [begin, end] of lost)
      ctx.fillRect(at(begin), bbox.top, Math.max(2, at(end) - at(begin)), bbox.height);
    ctx.strokeStyle = css('--loop');
    ctx.setLineDash([6, 4]);
    ctx.lineWidth = 1.5 * devicePixelRatio;
    for (const seconds of loops) {
      ctx.beginPath();
      ctx.moveTo(at(seconds), bbox.top);
      ctx.lineTo(at(seconds), bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
  }}};
}

/**
 * data: [x, y…]; series: [{label, colour, fill?, scale?, unit?, digits?}].
 * options: {height, xName, yName, y2Name, lost, loops, sync, bands}
 */
export function seriesChart(data, series, options) {
  const box = el('div', {class: 'chart'});
  let chart = null;
  const axis = (scale, label, side, grid) => ({scale, label, side, stroke: css('--ink'), labelSize: 18,
    size: side === 2 ? 32 : 52, labelFont: '12px system-ui', font: '12px system-ui',
    grid: {show: grid, stroke: css('--grid'), width: 1}, ticks: {stroke: css('--grid'), size: 4}});
  const draw = () => {
    chart?.destroy();
    chart = new uPlot({
      width: box.clientWidth || 560, height: options.height ?? 180,
      scales: {x: {time: false}, y: {range: (_, __, max) => [0, max > 0 ? 1.08 * max : 1]},
               y2: {range: (_, __, max) => [0, max > 0 ? 1.08 * max : 1]}},
      cursor: {sync: options.sync ? {key: options.sync} : undefined, drag: {x: true, y: false}},
      legend: {live: true},
      axes: [axis('x', options.xName, 2, true), axis('y', options.yName, 3, true),
             ...(options.y2Name ? [axis('y2', options.y2Name, 1, false)] : [])],
      series: [{label: options.xName, value: (_, v) => v?.toFixed(2) ?? '–'},
        ...series.map(s => ({label: s.label, stroke: s.colour, fill: s.fill, width: s.width ?? 1.5,
          scale: s.scale ?? 'y', spanGaps: false, points: {show: false}, show: s.show ?? true,
          value: s.value ?? ((_, v) => v?.toFixed(s.digits ?? 1) ?? '–')}))],
      bands: options.bands,
      plugins: [events(options.lost ?? [], options.loops ?? [])],
    }, data, box);
  };
  const fit = () => {
    if (!chart) draw();
    else if (box.clientWidth && Math.abs(box.clientWidth - chart.width) > 1)
      chart.setSize({width: box.clientWidth, height: options.height ?? 180});
  };
  new ResizeObserver(() => requestAnimationFrame(fit)).observe(box);
  redrawn(box, draw);
  return box;
}
