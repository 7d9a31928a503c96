// The colours of the text.

import { EditorView } from '@codemirror/view';

const wave = (colour: string) => ({ textDecoration: `underline wavy ${colour} 1px`, textUnderlineOffset: '3px', textDecorationSkipInk: 'none' });
const dot = (colour: string) => ({ '&::before': { background: colour } });

export const theme = EditorView.theme({
  '&': { height: '100%', color: 'var(--ink)', background: 'var(--panel)', fontSize: '12.5px' },
  '&.cm-focused': { outline: '2px solid var(--focus)', outlineOffset: '-2px' },
  '.cm-scroller': { fontFamily: 'var(--mono)', lineHeight: '1.5' },
  '.cm-content': { caretColor: 'var(--ink)' },
  '.cm-cursor': { borderLeftColor: 'var(--ink)' },
  '.cm-gutters': { background: 'var(--sunken)', color: 'var(--ink-3)', border: 'none', borderRight: '1px solid var(--line)' },
  '.cm-activeLine': { background: 'color-mix(in srgb, var(--accent) 6%, transparent)' },
  '.cm-activeLineGutter': { background: 'var(--hover)', color: 'var(--ink)' },
  '& .cm-selectionLayer .cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground': { background: 'light-dark(#cfe1fb, #24446f)' },
  '.od-section': { color: 'var(--sdo)', fontWeight: '600' },
  '.od-key': { color: 'var(--ink-2)' },
  '.od-value': { color: 'var(--ink)' },
  '.od-comment': { color: 'var(--ink-3)', fontStyle: 'italic' },
  '.od-error': wave('var(--bad)'),
  '.od-warning': wave('var(--amber)'),
  '.od-info': { textDecoration: 'underline dotted var(--ink-3) 1px', textUnderlineOffset: '3px' },
  '.od-dots': { width: '12px' },
  '.od-dot::before': { content: '""', display: 'block', width: '7px', height: '7px', margin: '6px 2px', borderRadius: '50%' },
  '.od-dot-error': dot('var(--bad)'),
  '.od-dot-warning': dot('var(--amber)'),
  '.od-dot-info': dot('var(--ink-3)'),
  '.cm-tooltip': { zIndex: '20', border: '1px solid var(--line-strong)', borderRadius: '8px', background: 'var(--raised)', color: 'var(--ink)', boxShadow: 'var(--shadow-high)' },
  '.od-prose': { maxWidth: 'min(520px, 80vw)', maxHeight: 'min(320px, 50vh)', overflow: 'auto', padding: '8px 12px', font: '400 12.5px/1.45 var(--font)' },
  '.od-prose p': { margin: '0 0 6px' },
  '.od-prose hr': { border: '0', borderTop: '1px solid var(--line)', margin: '8px 0' },
  '.od-prose code': { fontFamily: 'var(--mono)', fontSize: '0.94em' },
  '.cm-tooltip-hover': { maxHeight: 'min(55dvh, 30em)', overflowY: 'auto' },
  '.cm-tooltip.cm-tooltip-autocomplete > ul': { fontFamily: 'var(--mono)', maxHeight: '14em' },
  '.cm-tooltip-autocomplete ul li[aria-selected]': { background: 'var(--accent)', color: 'var(--on-accent)' },
  '.cm-completionDetail': { fontStyle: 'normal', color: 'var(--ink-2)' },
  '.cm-tooltip-autocomplete ul li[aria-selected] .cm-completionDetail': { color: 'inherit' },
  '.cm-completionMatchedText': { textDecoration: 'none', fontWeight: '700' },
  '.cm-panels': { background: 'var(--sunken)', color: 'var(--ink)', borderColor: 'var(--line)' },
  '.cm-panels.cm-panels-top': { borderBottom: '1px solid var(--line)' },
  '.cm-textfield': { border: '1px solid var(--line-strong)', borderRadius: '5px', background: 'var(--raised)', color: 'inherit', fontSize: '12px' },
  '.cm-button': { border: '1px solid var(--line-strong)', borderRadius: '5px', background: 'var(--raised)', backgroundImage: 'none', color: 'inherit', fontSize: '12px' },
  '.cm-panel.cm-search [name=close]': { color: 'inherit' },
  '.cm-searchMatch': { background: 'var(--amber-soft)', outline: '1px solid var(--amber)' },
  '.cm-searchMatch-selected': { background: 'var(--chosen)' },
});
