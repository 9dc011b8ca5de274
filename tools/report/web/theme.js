// Colours. Charts ask for them when they are drawn; a change of theme draws them again.

/** Safe for colour blindness (Okabe and Ito, 2008), readable on white and on dark. */
export const kinds = ['#1f86c8', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8c6bb1',
                      '#7a7a00', '#b15928', '#6b7785', '#1b9aaa', '#a83c64', '#5a9e3d', '#3f5fb5',
                      '#c9a400', '#9d6b53', '#7fb3a8'];
export const kind = i => kinds[i % kinds.length];

const ramp = [[59, 111, 212], [120, 80, 190], [190, 50, 130], [225, 80, 60], [245, 159, 0]];
/** From small (blue) to large (orange), 0 … 1. */
export function heat(share) {
  const at = Math.min(0.9999, Math.max(0, share)) * (ramp.length - 1), i = Math.floor(at);
  const mix = ramp[i].map((low, k) => Math.round(low + (at - i) * (ramp[i + 1][k] - low)));
  return `rgb(${mix.join(',')})`;
}

export const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Calls `draw` on a change of theme and around printing, as long as `element` is in the page. */
export function redrawn(element, draw) {
  const again = () => {
    if (element.isConnected) draw();
    else window.removeEventListener('themechange', again);
  };
  window.addEventListener('themechange', again);
}

const announce = () => window.dispatchEvent(new Event('themechange'));
function set(theme) {
  document.documentElement.dataset.theme = theme;
  announce();
}
const dark = () => document.documentElement.dataset.theme === 'dark';

/** Begins with what the system says; paper is light. */
export function startTheme() {
  const system = matchMedia('(prefers-color-scheme: dark)');
  set(system.matches ? 'dark' : 'light');
  system.addEventListener('change', () => set(system.matches ? 'dark' : 'light'));
  let screen = 'light';
  window.addEventListener('beforeprint', () => {
    screen = document.documentElement.dataset.theme;
    set('light');
  });
  window.addEventListener('afterprint', () => set(screen));
}
export function toggleTheme() { set(dark() ? 'light' : 'dark'); }
