// Annotated pictures: chosen frames, and those beside the worst moments.
import {picture} from './data.js';
import {el} from './dom.js';

function enlarge(source, caption) {
  const dialog = el('dialog', {onclick: () => dialog.close(), onclose: () => dialog.remove()},
                    el('img', {src: source, alt: caption}), el('p', {}, caption));
  document.body.append(dialog);
  dialog.showModal();
}

/** "frame 57: largest error: 42.1 mm", and below what tracking had of it. */
function captionOf(p) {
  return [`frame ${p.frame}${p.why ? ': ' + p.why : ''}`, p.state].filter(Boolean);
}

function frameFigure(p) {
  const lines = captionOf(p), source = picture(p.id);
  return el('figure', {class: p.why ? 'worst' : undefined},
    el('img', {src: source, alt: lines[0], onclick: () => enlarge(source, lines.join(': '))}),
    el('figcaption', {}, lines[0], ...lines.slice(1).map(line => el('div', {class: 'state'}, line))));
}

/** How the run would have drawn what the page can only show as it was recorded. */
function howToDraw(pictures) {
  const frames = pictures.filter(p => p.recorded).map(p => p.frame);
  if (!frames.length) return null;
  return el('p', {class: 'quiet'}, `As recorded, because the run has drawn ${
    pictures.length > frames.length ? 'other frames' : 'none'}: ${frames.join(', ')}. A run with `,
    el('code', {}, `--with 'images.frames=[${frames.join(', ')}]' --with images.panels=true`), ' draws them.');
}

export function frameGrid(run) {
  return el('div', {}, el('div', {class: 'frames'}, ...run.pictures.map(frameFigure)), howToDraw(run.pictures));
}
