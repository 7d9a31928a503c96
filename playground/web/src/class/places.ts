// Names of the places of a student that are not lessons. The address of a lesson has no `#`.

export const CASE = '#case';
/** The final test; also its address. */
export const TEST = '#test';
