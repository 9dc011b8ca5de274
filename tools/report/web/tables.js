// Tables that sort by a click on a heading.
import {el} from './dom.js';

function compare(a, b, rising) {
  const [x, y] = [a.v ?? null, b.v ?? null];
  if (x !== null && y !== null) return rising ? x - y : y - x;
  if (x !== null || y !== null) return x !== null ? -1 : 1;  // nothing comes last, either way
  return (rising ? 1 : -1) * a.t.localeCompare(b.t, undefined, {numeric: true});
}

/** Long names break behind an underscore. */
function breakable(text) {
  return text.split(/(?<=_)/).flatMap((part, i) => i ? [el('wbr'), part] : [part]);
}

function nameOf(cell, open) {
  if (!open) return el('th', {scope: 'row'}, ...breakable(cell.t));
  return el('th', {scope: 'row'}, el('a', {href: '#run', onclick: event => {
    event.preventDefault();
    open();
  }}, ...breakable(cell.t)));
}

function figureOf(cell, isText) {
  const marks = [cell.b && 'best', cell.s && 'significant', isText && 'text'].filter(Boolean).join(' ');
  // "0.0021 (0.0018–0.0024)": the spread stands back behind the figure.
  const [, head, spread] = /^(\S+?),?( .*)?$/s.exec(cell.t) ?? [null, cell.t, null];
  const text = cell.v === undefined || !spread ? [cell.t] : [head, el('span', {class: 'spread'}, spread.replace(' %', '\u00a0%'))];
  return el('td', {class: marks || undefined}, ...text);
}

/** So many digits that figures of 100 and more have no more than four. */
export const figureCell = (v, digits) => ({t: v.toFixed(v >= 100 ? Math.min(1, digits) : digits), v});

const manyColumns = 9;

/** `opener(name)`: what a click on the name of a row does, or nothing. */
export function table(data, opener = () => null) {
  const body = el('tbody'), names = data.names ?? 1;
  const isText = data.header.map((_, i) => data.rows.every(row => row[i].v === undefined));
  const cellOf = (cell, i) => i < names ? nameOf(cell, i === 0 && opener(cell.t)) : figureOf(cell, isText[i]);
  const fill = rows => body.replaceChildren(...rows.map(row => el('tr', {}, ...row.map(cellOf))));
  fill(data.rows);
  const headings = data.header.map((title, i) => el('th', {scope: 'col',
    class: isText[i] ? undefined : 'number', 'aria-sort': 'none'},
    el('button', {type: 'button', title: 'Sort', onclick: () => {
      const rising = headings[i].getAttribute('aria-sort') !== 'ascending';
      headings.forEach(h => h.setAttribute('aria-sort', 'none'));
      headings[i].setAttribute('aria-sort', rising ? 'ascending' : 'descending');
      fill([...data.rows].sort((a, b) => compare(a[i], b[i], rising)));
    }}, ...breakable(title))));
  return el('div', {class: data.header.length > manyColumns ? 'table dense' : 'table'},
            el('table', {}, el('thead', {}, el('tr', {}, ...headings)), body));
}

export function titledTable(data, opener) {
  return el('div', {class: 'titled'}, data.title ? el('h3', {}, data.title) : null, table(data, opener),
            data.note ? el('p', {class: 'quiet'}, data.note) : null);
}
