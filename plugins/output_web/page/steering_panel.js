// Buttons and keys that make the run do something.
import {COMMANDS} from './protocol.js';

const byId = (id) => document.getElementById(id);

export class SteeringPanel {
  /** `send` takes a command; `say` shows a sentence for a while. */
  constructor(send, say) {
    Object.assign(this, {send, say});
    byId('pause').addEventListener('click', () => this.pauseOrGoOn());
    byId('step').addEventListener('click', () => send(COMMANDS.step));
    byId('save').addEventListener('click', () => send(COMMANDS.saveMap));
    byId('end').addEventListener('click', () => byId('end-question').showModal());
    byId('end-question').addEventListener('close', ({target}) => {
      if (target.returnValue === 'end') send(COMMANDS.end);
      target.returnValue = '';
    });
    document.addEventListener('keydown', (event) => this.key(event));
    this.reset();
  }

  /** Without a run. */
  reset() { this.show({allowed: false, steerable: false, notes: -1}); }

  take(state) {
    const isNews = this.state.notes >= 0 && state.notes > this.state.notes;  // of before, nobody needs to know
    this.show(state);
    if (isNews) this.say(state.note);
  }

  show(state) {
    this.state = state;
    byId('steering').hidden = !state.allowed;
    for (const id of ['pause', 'step', 'end']) byId(id).hidden = !state.steerable;
    byId('paused').hidden = !state.paused;
    byId('pause').textContent = state.paused ? 'Go on' : 'Pause';
    byId('step').disabled = !state.paused;
    byId('save').hidden = !state.map_file;
    byId('save').title = `The sparse map as it is now, as ${state.map_file} (M)`;
    byId('end').disabled = !!state.ending;
    byId('end').textContent = state.ending ? 'Ending …' : 'End run';
  }

  pauseOrGoOn() { this.send(this.state.paused ? COMMANDS.goOn : COMMANDS.pause); }

  key(event) {
    const busy = event.target.closest('button, input, select, dialog') || event.ctrlKey || event.metaKey || event.altKey;
    if (busy || !this.state.allowed) return;
    const actions = {
      ' ': () => this.state.steerable && this.pauseOrGoOn(),
      '.': () => this.state.paused && this.send(COMMANDS.step),
      m: () => this.state.map_file && this.send(COMMANDS.saveMap),
    };
    if (!actions[event.key]) return;
    event.preventDefault();
    actions[event.key]();
  }
}
