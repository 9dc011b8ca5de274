// The pipeline of a run, and in what it differs from another one.
import {el} from './dom.js';
import {table} from './tables.js';

export function optionFigures(run) {
  if (!run.yaml) return [el('p', {class: 'quiet'}, 'The run has no pipeline.yaml.')];
  const parts = [];
  if (run.base && run.changes.length)
    parts.push(table({header: ['option', run.base, 'this run'],
      rows: run.changes.map(([key, base, value]) =>
        [{t: key}, {t: base || '–'}, {t: value || '–'}])}));
  else if (run.base)
    parts.push(el('p', {}, 'Every option is as in ', el('b', {}, run.base), '.'));
  parts.push(el('details', {}, el('summary', {}, 'Every option with its value (pipeline.yaml)'),
                el('pre', {}, run.yaml)));
  return parts;
}
