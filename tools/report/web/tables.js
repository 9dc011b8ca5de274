// Tables that sort by a click on a heading.
import {el} from './dom.js';

function compare(a, b, rising) {
  const [x, y] = [a.v ?? null, b.v ?? null];
  if (x !== null && y !== null) return rising ? x - y : y - x;
  if (x !== null || y !== null) return x !== null ? -1 : 1;  // nothing comes last, either way
  return (rising ? 1 : -1) * a.t.localeCompare(b.t, undefined, {numeric: true});
}

function cellOf(cell, i, open) {
  const marks = [cell.b && 'best', cell.s && 'significant'].filter(Boolean).join(' ');
  // "0.0021 (0.0018–0.0024)": the spread stands back behind the figure.
  const [, head, spread] = /^(\S+)( .*)?$/s.exec(cell.t) ?? [null, cell.t, null];
  const plain = i === 0 || cell.v === undefined || !spread;
  const text = plain ? [cell.t] : [head, el('span', {class: 'spread'}, spread)];
  if (i > 0) return el('td', {class: marks || undefined}, ...text);
  return el('th', {scope: 'row'}, open ? el('a', {href: '#run', onclick: event => {
    event.preventDefault();
    open();
  }}, cell.t) : cell.t);
}

/** `opener(name)`: what a click on the name of a row does, or nothing. */
export function table(data, opener = () => null) {
  const body = el('tbody');
  const fill = rows => body.replaceChildren(...rows.map(
      row => el('tr', {}, ...row.map((cell, i) => cellOf(cell, i, i === 0 && opener(cell.t))))));
  fill(data.rows);
  const numeric = data.header.map((_, i) => i > 0 && data.rows.some(row => row[i].v !== undefined));
  const headings = data.header.map((title, i) => el('th', {scope: 'col',
    class: numeric[i] ? 'number' : undefined, 'aria-sort': 'none'},
    el('button', {type: 'button', title: 'Sort', onclick: () => {
      const rising = headings[i].getAttribute('aria-sort') !== 'ascending';
      headings.forEach(h => h.setAttribute('aria-sort', 'none'));
      headings[i].setAttribute('aria-sort', rising ? 'ascending' : 'descending');
      fill([...data.rows].sort((a, b) => compare(a[i], b[i], rising)));
    }}, title)));
  return el('div', {class: 'table'},
            el('table', {}, el('thead', {}, el('tr', {}, ...headings)), body));
}

export function titledTable(data, opener) {
  return el('div', {class: 'titled'}, el('h3', {}, data.title), table(data, opener),
            data.note ? el('p', {class: 'quiet'}, data.note) : null);
}
