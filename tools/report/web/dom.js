// Elements in one line.

/** el('td', {class: 'best'}, 'text', child): attributes, event handlers (onclick), children. */
export function el(name, attributes = {}, ...children) {
  const svg = ['svg', 'path', 'line', 'rect', 'circle', 'text', 'g', 'title'].includes(name);
  const element = svg ? document.createElementNS('http://www.w3.org/2000/svg', name)
                      : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...children.filter(child => child !== null && child !== undefined));
  return element;
}

export function section(title, ...children) {
  return el('section', {}, el('h2', {}, title), ...children);
}

/** A chart with its caption. */
export function figure(caption, ...children) {
  return el('figure', {}, el('figcaption', {}, caption), ...children);
}

/** Buttons of which one is chosen. */
export function choice(names, chosen, choose) {
  const buttons = names.map((name, i) => el('button', {
    type: 'button', 'aria-pressed': String(i === chosen), onclick: () => {
      buttons.forEach((b, k) => b.setAttribute('aria-pressed', String(k === i)));
      choose(i);
    }}, name));
  return el('div', {class: 'choice', role: 'group'}, ...buttons);
}
