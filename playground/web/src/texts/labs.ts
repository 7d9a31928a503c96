// Texts of the labs: the master, and the physics of the bus line.

const micros = (nanos: number): string => (nanos < 10_000 ? `${Math.round(nanos)} ns` : `${(nanos / 1000).toFixed(1)} µs`);

export const labs = {
  labs: 'Labs',
  close: (name: string) => `Close ${name}`,
  failed: 'The lab could not be loaded. Check the connection and open it again.',
  master: {
    title: 'Master',
    summary: 'A small NMT master that you program by a list. It boots its slaves as CiA 302-2 says, and tells where it stopped and why.',
    list: 'The list of the master, one line each',
    hint: (node: number) => `slave ${node}\nexpect ${node} 1000h = 0x00020196\nwrite ${node} 1017h = 100\nheartbeat ${node} 250ms\nsync 50ms`,
    boot: 'Boot',
    bootTitle: 'The master takes this list and boots all nodes in it',
    clear: 'Clear',
    clearTitle: 'The master forgets its list and ends SYNC',
    changed: 'The list has changed. Boot takes it over.',
    line: (line: number, why: string) => `Line ${line}: ${why}`,
    none: 'The list is empty. A first line is “slave” and a node ID.',
    guide: 'Lines of the list',
    orders: [
      ['slave 5', 'boots node 5 (1F81h)'],
      ['expect 5 1018h:02 = 10', 'node 5 is started only with this value; also of 1000h and 1018h:01 to 04 (1F84h to 1F88h)'],
      ['write 5 1017h = 100', 'writes this value before the start (1F22h)'],
      ['heartbeat 5 250ms', 'node 5 is lost if its heartbeat does not come for this time (1016h)'],
      ['sync 50ms', 'sends SYNC with this period (1006h)'],
    ] as [string, string][],
    chart: (node: number) => `Boot process of node ${node}`,
    node: (node: number) => `Node ${node}`,
    stages: ['In the list', 'Reset', 'Boot-up', 'Device type', 'Identity', 'Configuration', 'Error control', 'Start'],
    objects: ['1F81h', 'NMT', '1F89h', '1F84h', '1F85h–1F88h', '1F22h', '1016h', 'NMT'],
    slave: { waiting: 'waits', booting: 'is booted', started: 'started', failed: 'failed', lost: 'lost' } as Record<string, string>,
    stage: { done: 'done', now: 'in progress', failed: 'stopped here', skipped: 'nothing to do', missed: 'did not come', open: 'not reached' } as Record<string, string>,
    status: (letter: string, meaning: string) => `Error status ${letter}: ${meaning}`,
    after: (millis: number) => `+${millis < 10 ? millis.toFixed(1) : Math.round(millis)} ms`,
    dcf: (node: number) => `1F22h:${node.toString(16).toUpperCase().padStart(2, '0')}, concise DCF`,
  },
  line: {
    title: 'Line',
    summary: 'Length, sample point, terminators and clocks of the bus line, with frames and error frames as their effect.',
    rate: 'Bit rate',
    traffic: 'To see its effect, let a node send: write 1000 to 1017h for a heartbeat.',
    length: 'Length',
    metres: (metres: number) => (metres ? `${metres} m` : 'bench'),
    samplePoint: 'Sample point',
    sjw: 'SJW',
    quanta: (sjw: number, all: number) => `${sjw}/${all} bit`,
    clock: (node: number) => `Clock of node ${node}`,
    slow: (value: number) => (value === 0 ? 'exact' : `${Math.abs(value).toFixed(1)} % ${value > 0 ? 'too slow' : 'too fast'}`),
    terminators: 'Terminators',
    bit: (rate: number, bit: number) => `One bit at ${rate} kbit/s, ${micros(bit)}`,
    sampled: (time: number) => `sampled after ${micros(time)}`,
    returns: (time: number) => `there and back ${micros(time)}`,
    settles: (time: number) => `recessive after ${micros(time)}`,
    verdict: (isLate: boolean, isSlow: boolean, longest: number) =>
      isLate
        ? `The acknowledgement comes after the sample point: the sender does not see it. At this bit rate and sample point the line may have ${longest} m.`
        : isSlow
          ? 'The line is still dominant when a recessive bit is sampled: it lacks terminators.'
          : `The acknowledgement comes before the sample point. At this bit rate and sample point the line may have ${longest} m.`,
    bench: 'The short line of a bench: its delay does not matter. Give it a length.',
    tolerance: (percent: number) => `Two clocks may differ by ${percent.toFixed(2)} %.`,
    table: (rate: number, metres: number) => `CiA 301: ${metres} m at ${rate} kbit/s.`,
    counters: 'Error counters',
    page: 'Interface',
    tec: 'TEC',
    rec: 'REC',
  },
};
