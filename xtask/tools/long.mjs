// A reporter of `node --test`, beside another one: names each test that takes long, as the test programs of cargo do, and
// says when it ended. In the log of a run that hangs, these are the tests that did not end.
import { Transform } from 'node:stream';

const LIMIT_S = 60;
/** The tests that run: their timers until they take long, then null. */
const running = new Map();

const key = ({ name, file, line }) => `${file}:${line} ${name}`;

export default new Transform({
  writableObjectMode: true,
  transform({ type, data }, _encoding, done) {
    // A file is a test as well, whose name is that of the file.
    const isFile = data.file?.endsWith(data.name);
    if (type === 'test:dequeue' && !isFile) {
      const tell = () => {
        running.set(key(data), null);
        this.push(`\n# ${data.name} has been running for over ${LIMIT_S} seconds\n`);
      };
      running.set(key(data), setTimeout(tell, LIMIT_S * 1000));
    } else if (['test:complete', 'test:pass', 'test:fail'].includes(type) && running.has(key(data))) {
      const timer = running.get(key(data));
      running.delete(key(data));
      clearTimeout(timer);
      if (timer === null) this.push(`\n# ${data.name} ... ended\n`);
    }
    done();
  },
  flush(done) {
    running.forEach(clearTimeout);
    done();
  },
});
