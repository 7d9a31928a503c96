// The style sheet of a real bus, which the first visit does not need.

/** Resolves when it acts. */
export const styled = new Promise<void>((resolve) => {
  const link = document.createElement('link');
  link.rel = 'stylesheet';
  link.href = new URL('real.css', import.meta.url).href;
  link.onload = link.onerror = () => resolve();
  document.head.append(link);
});
