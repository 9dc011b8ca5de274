// The blocks that the program has put into the page: base64, most of it of gzip.

function bytesOf(id) {
  const block = document.getElementById(id);
  if (!block) throw new Error(`the report lacks its part '${id}': the file is incomplete`);
  return Uint8Array.from(atob(block.textContent), c => c.charCodeAt(0));
}

/** ArrayBuffer of a packed block. */
export function unpacked(id) {
  const stream = new Blob([bytesOf(id)]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

export async function json(id) {
  return JSON.parse(new TextDecoder().decode(await unpacked(id)));
}

/** Address of a JPEG that lies in the page. */
export function picture(id) {
  return 'data:image/jpeg;base64,' + document.getElementById(id).textContent;
}

const runs = new Map();
/** A run by its place in the list, unpacked once. */
export function run(index) {
  if (!runs.has(index)) runs.set(index, json(`run-${index}`));
  return runs.get(index);
}

/** Series are integers, counts of a step. */
export const scaled = (numbers, step) => numbers.map(n => n === null ? null : n * step);

/** Of metres, as short as it can be read. */
export const lengthText = metres => metres < 1 ? `${(1000 * metres).toFixed(1)} mm` : `${metres.toFixed(2)} m`;
