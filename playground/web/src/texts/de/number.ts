// Numbers in German texts.

/** A number with thin spaces between its thousands, as `format.ts` writes them: a point is the decimal point of logs. */
export const grouped = (value: number): string => value.toLocaleString('de').replaceAll('.', '\u2009');
