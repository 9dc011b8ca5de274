// Put behind a report's page by the test: waits until it is drawn, sorts a table, turns the map, replays the run, and
// writes what it saw.
const seen = {errors: []};
addEventListener('error', event => seen.errors.push(event.message));
addEventListener('unhandledrejection', event => seen.errors.push(String(event.reason)));

function texts(table, column) {
  return [...table.querySelectorAll('tbody tr')].map(row => row.children[column].textContent);
}

function sortTwice() {
  const table = [...document.querySelectorAll('table')].find(t => t.rows.length > 3);
  const button = () => table.querySelectorAll('thead button')[1];
  button().click();
  seen.rising = texts(table, 1).map(parseFloat);
  button().click();
  seen.falling = texts(table, 1).map(parseFloat);
}

function turnMap() {
  const canvas = document.querySelector('canvas.map');
  if (!canvas) return;
  canvas.setPointerCapture = canvas.releasePointerCapture = () => {};  // no pointer is really there
  const before = canvas.toDataURL();
  const pointer = (name, x) => canvas.dispatchEvent(new PointerEvent(name, {bubbles: true, pointerId: 1,
    button: 0, buttons: 1, clientX: x, clientY: 200, pageX: x, pageY: 200}));
  pointer('pointerdown', 300);
  pointer('pointermove', 420);
  pointer('pointermove', 480);
  pointer('pointerup', 480);
  seen.turned = canvas.toDataURL() !== before;
  const shown = canvas.toDataURL();
  document.querySelectorAll('.map-bar .choice button')[1].click();
  seen.repainted = canvas.toDataURL() !== shown;
}

/** Whether the recorded live view loads within the page. */
function replay() {
  const loaded = new Promise(resolve => {
    setTimeout(() => resolve(false), 10000);
    document.addEventListener('load', event => event.target.matches?.('.replay iframe') && resolve(true), true);
  });
  document.querySelector('.replay-run').click();
  return loaded;
}

/** Whether something other than one colour is on it. */
function isDrawn(canvas) {
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return data.some((value, i) => i >= 4 && value !== data[i % 4]);
}

function look() {
  const ready = document.documentElement.dataset.ready;
  if (!ready) return setTimeout(look, 50);
  setTimeout(async () => {
    try {
      seen.ready = ready;
      seen.command = document.querySelector('#top code').textContent;
      seen.charts = [...document.querySelectorAll('.uplot canvas')].filter(isDrawn).length;
      seen.lines = document.querySelectorAll('svg.path path.coloured').length;
      seen.pictures = [...document.querySelectorAll('.frames img')].filter(i => i.naturalWidth).length;
      sortTwice();
      turnMap();
      seen.replayed = await replay();
    } catch (error) {
      seen.errors.push(String(error));
    }
    const result = document.createElement('pre');
    result.id = 'probe';
    result.textContent = JSON.stringify(seen);
    document.body.append(result);
  }, 300);
}
look();
