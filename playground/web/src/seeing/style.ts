// The style sheet of views that are loaded on request.

const link = Object.assign(document.createElement('link'), { rel: 'stylesheet', href: new URL('seeing.css', import.meta.url).href });
await new Promise((resolve) => {
  link.onload = link.onerror = resolve;
  document.head.append(link);
});
