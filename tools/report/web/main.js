// The page: header, overview, recordings, one run.
import './page.css';

import {json, run as loadRun} from './data.js';
import {el, section} from './dom.js';
import {recordingView, representatives} from './recording_view.js';
import {runView} from './run_view.js';
import {stageBars} from './stages.js';
import {titledTable} from './tables.js';
import {startTheme, toggleTheme} from './theme.js';

function header(report) {
  document.title = `${report.title} · Stillpoint report`;
  const lines = [report.command && el('code', {}, report.command), ...report.origins];
  document.getElementById('top').replaceChildren(
    el('div', {class: 'title'}, el('h1', {}, report.title),
       el('button', {type: 'button', class: 'theme', title: 'Dark or light', onclick: toggleTheme}, '◐')),
    ...(report.question ? [el('p', {class: 'question'}, report.question)] : []),
    el('p', {class: 'origin'}, ...lines.filter(Boolean).flatMap((line, i) => i ? [el('br'), line] : [line])));
  document.getElementById('foot').replaceChildren(`Written by ${report.written_by}`);
}

function notes(report) {
  if (!report.notes.length) return null;
  const items = report.notes.map(note => el('p', {}, note)), shown = 4;
  return el('div', {class: 'warning'}, ...items.slice(0, shown), items.length > shown
    ? el('details', {}, el('summary', {}, `${items.length - shown} more`), ...items.slice(shown)) : null);
}

/** Mean CPU per stage of each variant, or of each run. */
function timeOfVariants(report) {
  const sums = new Map();
  for (const run of report.runs) {
    if (!run.stages.length) continue;
    const name = run.variant, sum = sums.get(name) ?? {count: 0, stages: new Map()};
    ++sum.count;
    for (const [stage, ms] of run.stages) sum.stages.set(stage, (sum.stages.get(stage) ?? 0) + ms);
    sums.set(name, sum);
  }
  return [...sums].map(([name, sum]) => ({name, stages: [...sum.stages].map(([s, ms]) => [s, ms / sum.count])}));
}

function overview(report, open) {
  const opener = name => {
    const index = report.runs.findIndex(run => run.name === name);
    return index < 0 ? null : () => open(index);
  };
  if (report.runs.length === 1 && report.tables.length === 1) return notes(report);  // the run says it all
  const [first, ...rest] = report.tables;
  const untitled = first.title === 'Overview' ? {...first, title: ''} : first;  // as the section
  const parts = [notes(report), titledTable(untitled, opener)];
  const compared = rest.filter(t => t.title.startsWith('Compared with'));
  parts.push(...compared.map(t => titledTable(t, opener)));
  const others = rest.filter(t => !compared.includes(t));
  if (report.runs.length > 1 && timeOfVariants(report).length)
    parts.push(el('div', {class: 'titled'}, el('h3', {}, 'CPU time per frame by stage, mean'),
                  stageBars(timeOfVariants(report), report.stage_titles)));
  if (others.length)
    parts.push(...others.map(t => el('details', {class: 'more', open: t.title === 'Runs' && t.rows.length <= 30},
      el('summary', {}, t.title), titledTable(t, opener))));
  return section('Overview', ...parts);
}

/** A list to choose from, and what is chosen below it. */
function chooser(title, names, id, show) {
  const place = el('div', {class: 'place'});
  const select = el('select', {id, onchange: () => choose(select.selectedIndex)},
                    ...names.map(name => el('option', {}, name)));
  const choose = async i => {
    select.selectedIndex = i;
    place.replaceChildren(await show(i));
  };
  const part = el('section', {class: 'chooser'}, el('h2', {}, title, ' ', names.length > 1 ? select
    : el('span', {class: 'only'}, names[0])), place);
  return {part, choose};
}

const nextPicture = () => new Promise(resolve => { requestAnimationFrame(resolve); });

async function build() {
  startTheme();
  const report = await json('report');
  header(report);
  const main = document.getElementById('main');
  const run = report.runs.length ? chooser('Run', report.runs.map(r => r.name), 'run',
    async i => runView(await loadRun(i))) : null;
  const open = async index => {
    await run.choose(index);
    run.part.scrollIntoView({behavior: 'smooth'});
  };
  const parts = [];
  const recordings = [...new Set(report.runs.map(r => r.recording))]
    .filter(name => representatives(report, name).length > 1);
  const recording = recordings.length ? chooser('Recording', recordings, 'recording',
    i => recordingView(report, recordings[i])) : null;
  parts.push(report.tables.length ? overview(report, open) : null, recording?.part, run?.part);
  main.replaceChildren(...parts.filter(Boolean));
  await recording?.choose(0);
  await run?.choose(0);
  for (let i = 0; i < 3; ++i) await nextPicture();  // charts are drawn when their size is known
}

build().then(() => { document.documentElement.dataset.ready = 'yes'; }, error => {
  document.documentElement.dataset.ready = 'failed';
  document.getElementById('main').replaceChildren(
    el('p', {class: 'warning'}, `The report cannot be shown: ${error.message}`));
});
