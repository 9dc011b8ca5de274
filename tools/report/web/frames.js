// Annotated pictures: chosen frames, and those beside the worst moments.
import {picture} from './data.js';
import {el} from './dom.js';

function enlarge(source, caption) {
  const dialog = el('dialog', {onclick: () => dialog.close(), onclose: () => dialog.remove()},
                    el('img', {src: source, alt: caption}), el('p', {}, caption));
  document.body.append(dialog);
  dialog.showModal();
}

export function frameGrid(run) {
  return el('div', {class: 'frames'}, ...run.pictures.map(p => {
    const caption = `frame ${p.frame}${p.why ? ': ' + p.why : ''}`, source = picture(p.id);
    return el('figure', {class: p.why ? 'worst' : undefined},
              el('img', {src: source, alt: caption, onclick: () => enlarge(source, caption)}),
              el('figcaption', {}, caption));
  }));
}
