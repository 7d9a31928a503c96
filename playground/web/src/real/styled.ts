// The style sheet for a real bus; the first visit does not load it.

/** Resolves when the style sheet is active. */
export const styled = new Promise<void>((resolve) => {
  const link = document.createElement('link');
  link.rel = 'stylesheet';
  link.href = new URL('real.css', import.meta.url).href;
  link.onload = link.onerror = () => resolve();
  document.head.append(link);
});
