// The live view of the run, as the output `web` has recorded it: a page of its own within this one.
import {unpacked} from './data.js';
import {el} from './dom.js';

/** `id` of its block or, where it is too large for this page, the `file`. */
export function replayView({id, file}) {
  const place = el('div', {class: 'replay on-screen'});
  const show = async () => {
    const src = file?.split('/').map(encodeURIComponent).join('/')
      ?? URL.createObjectURL(new Blob([await unpacked(id)], {type: 'text/html'}));
    place.replaceChildren(el('iframe', {title: 'The run, replayed', sandbox: 'allow-scripts', src}));
  };
  place.append(el('button', {type: 'button', class: 'replay-run', onclick: show}, 'Replay the run'),
               file ? el('span', {class: 'quiet'}, ` from ${file}`) : '');
  return place;
}
