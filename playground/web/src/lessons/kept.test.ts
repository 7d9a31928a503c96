import { assert, test } from '../testing';
import { codeOf } from './kept';

test('the code of a learner is the one that `odkit lesson progress` reads', () => {
  // The same code is in crates/od-cli/tests/all/lesson.rs.
  assert.equal(
    codeOf(' Ann Ü.', { nmt: [5, 5, '2026-11-22'], sdo: [2, 6, '2026-11-23'] }),
    'odkit-progress/1 learner=Ann%20%C3%9C. nmt=5/5@2026-11-22 sdo=2/6@2026-11-23 sum=1AD6B914',
  );
});
