// Dark or light theme: the system's setting until the user selects one.

const listeners: ((dark: boolean) => void)[] = [];
let chosen: boolean | null = null;
const system = window.matchMedia('(prefers-color-scheme: dark)');

export const isDark = (): boolean => chosen ?? system.matches;

function apply(): void {
  document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
  for (const listener of listeners) listener(isDark());
}

export function onTheme(listener: (dark: boolean) => void): void {
  listeners.push(listener);
}
export function toggleTheme(): void {
  chosen = !isDark();
  apply();
}
export function startTheme(): void {
  system.addEventListener('change', apply);
  apply();
}
