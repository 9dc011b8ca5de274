// A recorded run, whose messages are within the page.
import {read} from './protocol.js';

const byId = (id) => document.getElementById(id);
const LONGEST_WAIT = 1000;  // ms between two messages

/** Null where the page is none. Of a process that was killed, the last message may be cut off: it is left out. */
export function recording() {
  const messages = [...document.querySelectorAll('script.message')];
  if (messages.length === 0) return null;
  const whole = isWhole(messages.at(-1));
  return {messages: whole ? messages : messages.slice(0, -1), endsEarly: !whole};
}

function isWhole(message) {
  try {
    read(bytesOf(message), () => {});
    return true;
  } catch {
    return false;
  }
}

function bytesOf(element) {
  const text = atob(element.textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

export class Replay {
  /** `take` digests one message, `draw` shows what is known then, `clock` tells the run's time in seconds. */
  constructor(messages, {take, draw, clock}) {
    Object.assign(this, {messages, take, draw, clock, next: 0, playing: true});
    byId('replay').hidden = false;
    this.slider = byId('replay-place');
    this.slider.max = messages.length;
    this.slider.addEventListener('input', () => this.seek(+this.slider.value));
    byId('replay-play').addEventListener('click', () => this.setPlaying(!this.playing));
    byId('replay-step').addEventListener('click', () => this.step());
    document.addEventListener('keydown', (event) => this.key(event));
    this.play();
  }

  setPlaying(playing) {
    if (playing && this.next === this.messages.length) this.next = 0;
    this.playing = playing;
    byId('replay-play').textContent = playing ? 'Pause' : 'Play';
    clearTimeout(this.timer);
    if (playing) this.play();
  }

  async play() {
    const before = this.clock();
    const begin = performance.now();
    await this.advance(this.next + 1);
    if (!this.playing) return;
    if (this.next === this.messages.length) return this.setPlaying(false);
    const speed = +byId('replay-speed').value;
    const wait = Math.min(LONGEST_WAIT, 1000 * Math.max(0, this.clock() - before) / speed);
    this.timer = setTimeout(() => this.play(), Math.max(0, wait - (performance.now() - begin)));
  }

  step() {
    this.setPlaying(false);
    if (this.next < this.messages.length) this.advance(this.next + 1);
  }

  /** Messages tell what has changed: going back means to begin again. */
  seek(place) {
    this.setPlaying(false);
    if (place < this.next) this.next = 0;
    this.advance(Math.max(1, place));
  }

  async advance(place) {
    const changed = new Set();
    while (this.next < place) this.take(bytesOf(this.messages[this.next++]), changed);
    this.slider.value = this.next;
    await this.draw(changed);
  }

  key(event) {
    if (event.target.closest('button, input, select') || ![' ', '.'].includes(event.key)) return;
    event.preventDefault();
    if (event.key === '.') this.step();
    else this.setPlaying(!this.playing);
  }
}
