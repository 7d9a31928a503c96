// The styles of what comes when it is asked for: there before anything is drawn with them.

const link = Object.assign(document.createElement('link'), { rel: 'stylesheet', href: new URL('seeing.css', import.meta.url).href });
await new Promise((resolve) => {
  link.onload = link.onerror = resolve;
  document.head.append(link);
});
