import { assert, test } from '../testing';
import { codeOf } from './kept';

test('the code of a learner is the one that `odkit lesson progress` reads', () => {
  // The same code is in crates/od-cli/tests/all/lesson.rs.
  assert.equal(
    codeOf(' Ann Ü.', { nmt: [5, 5, '2026-11-22'], sdo: [2, 6, '2026-11-23', 0] }),
    'odkit-progress/1 learner=Ann%20%C3%9C. nmt=5/5@2026-11-22 sdo=2/6@2026-11-23 sum=1AD6B914',
  );
});

test('steps that were shown are counted apart', () => {
  assert.match(codeOf('Ann', { nmt: [5, 5, '2026-11-22', 2] }), / nmt=5\/5~2@2026-11-22 /);
});
