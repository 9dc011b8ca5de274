// The page: asks for what is new, shows it, and asks again when that is done. A hidden page does not ask. With
// messages of a recording within, it shows these instead.
import './style.css';

import {ChartPanel} from './chart_panel.js';
import {ImagePanel} from './image_panel.js';
import {MapPanel} from './map_panel.js';
import {order, OTHER_VERSION, read, request} from './protocol.js';
import {recording, Replay} from './replay.js';
import {Run} from './run.js';
import {SteeringPanel} from './steering_panel.js';

const BETWEEN_REQUESTS = 66;  // ms
const BETWEEN_CHARTS = 500;   // ms
const RETRY = 1500;           // ms
const TOAST = 6000;           // ms
const POLICY_ERROR = 1008;    // the server closes with it what does not speak its protocol
const REFUSALS = [403, 503];  // it does not let the page in, or has no room for it now

const byId = (id) => document.getElementById(id);
const image = new ImagePanel();
const map = mapPanel();
const charts = new ChartPanel();
let run = new Run();
let chartsDrawn = -Infinity;
let chartsDue = null;  // a timer
let toastEnd = 0;
const arrivals = [];  // {at, frames}, of the last seconds

/** Browsers without WebGL show the rest. */
function mapPanel() {
  try {
    return new MapPanel();
  } catch (error) {
    byId('map').textContent = 'This browser draws no 3-D (WebGL), so there is no map.';
    return {show() {}, reset() {}, chooseSurfaces() {}, wanted: {}};
  }
}

const live = {socket: null, due: 0};  // due: a timer, of the next request
const steering = new SteeringPanel((command) => live.socket?.send(order(command)), toast);

/** In place of the request before, if that has no answer yet. */
function ask() {
  clearTimeout(live.due);
  if (live.socket?.readyState === WebSocket.OPEN) live.socket.send(request({image: true, map: true, ...map.wanted}));
}

function connect() {
  const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
  const socket = live.socket = new WebSocket(`${scheme}//${location.host}/live${location.search}`);
  let opened = false;
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => {
    opened = true;
    say('live');
    ask();
  };
  socket.onmessage = async ({data}) => {
    const begin = performance.now();
    const changed = new Set();
    try {
      take(data, changed);
    } catch (error) {
      if (error.message !== OTHER_VERSION) throw error;
      socket.close();
      return giveUp();
    }
    await draw(changed);
    const rest = BETWEEN_REQUESTS - (performance.now() - begin);
    clearTimeout(live.due);
    live.due = setTimeout(() => requestAnimationFrame(ask), Math.max(0, rest));
  };
  socket.onclose = async ({code}) => {
    if (code === POLICY_ERROR) return giveUp();
    steering.reset();
    const refused = opened ? '' : await refusal();
    say(refused || (run.end ? endWords(run.end) : 'no connection, trying again'));
    setTimeout(connect, RETRY);
  };
  const giveUp = () => {  // asking again would not help
    socket.onclose = null;
    steering.reset();
    say(OTHER_VERSION);
  };
}

/** Why the server does not let this page in; a WebSocket does not tell. Empty where there is no server that says so. */
async function refusal() {
  try {
    const answer = await fetch(`/live${location.search}`);
    return REFUSALS.includes(answer.status) ? await answer.text() : '';
  } catch {
    return '';
  }
}

/** Shows a recording that is within the page. */
function replay({messages, endsEarly}) {
  byId('surfaces').value = 'voxels';
  map.chooseSurfaces();
  say(endsEarly ? 'the recording ends early' : 'recording');
  if (messages.length === 0) return;
  new Replay(messages, {take, draw, clock: () => run.frames.at(-1)?.time ?? 0});
}

function endWords(end) {
  if (end.failure) return `the run has failed: ${end.failure}`;
  return end.complete ? 'the run has ended' : 'the run was stopped';
}

function say(text) { byId('connection').textContent = text; }

/** Adds to what is known; names of the records go into `changed`. */
function take(data, changed) {
  read(data, (name, content) => {
    if (name === 'hello') begin();
    if (name !== 'steering') run.take(name, content);
    else if (live.socket) steering.take(content);  // a recording cannot be steered
    changed.add(name);
  });
}

async function draw(changed) {
  map.show(run, changed);
  showFigures();
  if (changed.has('loop')) toast(loopWords(run.loops.at(-1)));
  drawCharts();
  if (run.end) say(endWords(run.end));
  await image.show(run);
}

/** Now, or soon: the last state is drawn in any case. */
function drawCharts() {
  const rest = run.end ? 0 : BETWEEN_CHARTS - (performance.now() - chartsDrawn);
  if (rest > 0) {
    chartsDue ??= setTimeout(drawCharts, rest);
    return;
  }
  clearTimeout(chartsDue);
  chartsDue = null;
  chartsDrawn = performance.now();
  charts.show(run);
}

function begin() {
  run = new Run();
  map.reset();
  charts.reset();
  arrivals.length = 0;
  chartsDrawn = -Infinity;
}

function loopWords({frame, moved, shift, count}) {
  const what = count === 1 ? 'Loop' : `${count} loops`;
  return `${what} closed at frame ${frame}: ${moved} key frames moved, by up to ${(100 * shift).toFixed(1)} cm`;
}

function toast(text) {
  byId('toast').textContent = text;
  byId('toast').hidden = false;
  clearTimeout(toastEnd);
  toastEnd = setTimeout(() => { byId('toast').hidden = true; }, TOAST);
}

function framesPerSecond() {
  if (run.end) return run.frames.length / run.end.wall_seconds;
  const now = performance.now();
  arrivals.push({at: now, frames: run.frames.length});
  while (arrivals.length > 2 && now - arrivals[0].at > 3000) arrivals.shift();
  const [first] = arrivals;
  return now > first.at ? 1000 * (run.frames.length - first.frames) / (now - first.at) : 0;
}

function showFigures() {
  const last = run.frames.at(-1);
  if (!last) return;
  byId('run').textContent = run.hello.run;
  const state = byId('state');
  state.textContent = last.state === 'lost' ? 'LOST' : last.state;
  state.className = `badge ${last.state}`;
  document.title = `${last.state === 'lost' ? 'LOST · ' : ''}${run.hello.run || 'Stillpoint'} · Stillpoint`;
  const figures = [
    ['frames', run.seen],
    ...live.socket || run.end ? [['frames/s', framesPerSecond().toFixed(1)]] : [],  // a recording has its own pace
    ['coverage', `${(100 * run.tracked / run.seen).toFixed(0)} %`], ['times lost', run.timesLost],
    ['dropped', run.dropped], ...run.leftOut ? [['left out by the source', run.leftOut]] : [],
    ['key frames', run.keyframeCount], ['landmarks', run.landmarks.size],
    ['loops', run.loopsClosed]];
  if (run.fit) figures.push(['ATE, RMSE', `${(100 * run.fit.rmse).toFixed(1)} cm`]);
  byId('figures').replaceChildren(...figures.map(([name, value]) => {
    const box = document.createElement('div');
    const [dt, dd] = [document.createElement('dt'), document.createElement('dd')];
    dt.textContent = name;
    dd.textContent = value;
    box.append(dt, dd);
    return box;
  }));
}

// A run that is paused sends nothing new, so what has been asked for before would never be answered.
byId('surfaces').addEventListener('change', ask);

// The messages of a recording come after this script.
document.addEventListener('DOMContentLoaded', () => {
  const recorded = recording();
  if (recorded) replay(recorded);
  else connect();
});
