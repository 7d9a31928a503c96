//! Program download (CiA 302-3) if the memory fails, and after a power cycle.
//! `crates/odkit/tests/boot_loader.rs` tests the transfers.

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::Instant;
use od_runtime::program::{Loader, MemoryFailed, Program, ProgramMemory};

/// Sixteen bytes in four pages.
#[derive(Default)]
struct Chip {
    bytes: [u8; 16],
    stored: Option<Program>,
    pages: Vec<(u32, Vec<u8>)>,
    /// Number of commands that succeed before one fails.
    works: Option<usize>,
    /// Time until which it erases or writes.
    busy_until: Option<Instant>,
}

impl Chip {
    fn command(&mut self) -> Result<(), MemoryFailed> {
        match &mut self.works {
            Some(0) => Err(MemoryFailed),
            Some(left) => {
                *left -= 1;
                Ok(())
            }
            None => Ok(()),
        }
    }
}

impl ProgramMemory for Chip {
    fn size(&self) -> u32 {
        16
    }

    fn ready(&mut self, now: Instant) -> Result<(), Instant> {
        match self.busy_until.filter(|until| *until > now) {
            Some(until) => Err(until),
            None => Ok(()),
        }
    }

    fn erase(&mut self, _: Instant) -> Result<(), MemoryFailed> {
        self.stored = None;
        self.command()
    }

    fn write(&mut self, _: Instant, at: u32, page: &[u8]) -> Result<(), MemoryFailed> {
        self.pages.push((at, page.to_vec()));
        let at = at as usize;
        self.bytes[at..at + page.len()].copy_from_slice(page);
        self.command()
    }

    fn read(&mut self, at: u32, to: &mut [u8]) {
        let at = at as usize;
        to.copy_from_slice(&self.bytes[at..at + to.len()]);
    }

    fn complete(&mut self, _: Instant, program: Program) -> Result<(), MemoryFailed> {
        self.command()?;
        self.stored = Some(program);
        Ok(())
    }

    fn stored(&mut self) -> Option<Program> {
        self.stored
    }
}

fn bench(chip: Chip) -> Bench<Loader<Chip, 4>> {
    use Access::{Ro, Rw};
    let mut rows = rows();
    rows.extend([
        (0x1F50, 2, DataType::Domain, Rw, false, None),
        (0x1F51, 2, DataType::Unsigned8, Rw, false, unsigned(0)),
        (0x1F56, 2, DataType::Unsigned32, Ro, false, unsigned(0)),
        (0x1F57, 2, DataType::Unsigned32, Ro, false, unsigned(0)),
    ]);
    let mut bench = Bench::with(rows, Loader::new(chip, 2));
    bench.power_on();
    bench
}

/// Writes nine bytes; returns the last response.
fn load(bench: &mut Bench<Loader<Chip, 4>>) -> String {
    let mut answer = String::new();
    for request in ["21501F0209000000", "0031323334353637", "1B38390000000000"] {
        answer = bench.ask(&format!("601#{request}"));
        if answer.starts_with("581#80") {
            break;
        }
    }
    answer
}

const DONE: &str = "581#3000000000000000";
const HARDWARE: &str = "581#80501F0200000606";

#[test]
fn a_program_goes_into_the_memory_page_by_page() {
    let mut bench = bench(Chip::default());
    assert_eq!(load(&mut bench), DONE);
    let pages = &bench.node.application.memory.pages;
    let expected = [(0, "1234"), (4, "5678"), (8, "9")];
    assert_eq!(
        *pages,
        expected.map(|(at, page)| (at, page.as_bytes().to_vec()))
    );
    // CRC-32 of "123456789".
    assert_eq!(bench.ask("601#40561F0200000000"), "581#43561F022639F4CB");
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0200000000");
    assert_eq!(bench.ask("601#2F511F0201000000"), "581#60511F0200000000");
    assert!(bench.node.application.is_running());
    // NMT reset communication keeps it running, reset node does not.
    bench.send("000#8201");
    assert_eq!(bench.ask("601#40511F0200000000"), "581#4F511F0201000000");
    bench.send("000#8101");
    assert_eq!(bench.ask("601#40511F0200000000"), "581#4F511F0200000000");
    assert_eq!(bench.ask("601#40561F0200000000"), "581#43561F022639F4CB");
}

#[test]
fn a_program_is_still_there_after_a_power_cycle() {
    let mut bench = bench(Chip::default());
    load(&mut bench);
    bench.power_cycle();
    assert_eq!(bench.ask("601#40561F0200000000"), "581#43561F022639F4CB");
    assert_eq!(bench.ask("601#2F511F0201000000"), "581#60511F0200000000");
    bench.node.application.memory.stored = None;
    bench.power_cycle();
    assert_eq!(bench.ask("601#40561F0200000000"), "581#43561F0200000000");
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0202000000");
    assert_eq!(bench.ask("601#2F511F0201000000"), "581#80511F0224000008");
}

#[test]
fn a_memory_that_fails_is_a_hardware_error_and_has_no_program() {
    // An erasure, three pages, and the end.
    for works in 0..5 {
        let mut bench = bench(Chip {
            works: Some(works),
            ..Chip::default()
        });
        assert_eq!(load(&mut bench), HARDWARE, "{works}");
        // 1F57h: flash write error, code 5.
        assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F020A000000");
        assert_eq!(bench.ask("601#40561F0200000000"), "581#43561F0200000000");
        bench.node.application.memory.works = None;
        assert_eq!(load(&mut bench), DONE);
        assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0200000000");
    }
    let mut bench = bench(Chip::default());
    load(&mut bench);
    bench.node.application.memory.works = Some(0);
    assert_eq!(bench.ask("601#2F511F0203000000"), "581#60511F0200000000");
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F020A000000");
}

#[test]
fn the_objects_of_other_programs_are_missing() {
    let mut bench = bench(Chip::default());
    assert_eq!(bench.ask("601#2F511F0101000000"), "581#80511F0111000906");
    assert_eq!(bench.ask("601#21501F0111000000"), "581#80501F0111000906");
    assert_eq!(bench.ask("601#21501F0211000000"), "581#80501F0212000706");
}

#[test]
fn a_program_can_fill_the_memory_but_not_exceed_it() {
    let mut bench = bench(Chip::default());
    assert_eq!(bench.ask("601#21501F0210000000"), "581#60501F0200000000");
    assert_eq!(bench.ask("601#0031323334353637"), "581#2000000000000000");
    assert_eq!(bench.ask("601#1038393A3B3C3D3E"), "581#3000000000000000");
    assert_eq!(bench.ask("601#0B3F400000000000"), "581#2000000000000000");
    assert_eq!(bench.node.application.program().map(|it| it.len), Some(16));
    // The upload.
    assert_eq!(bench.ask("601#40501F0200000000"), "581#41501F0210000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0031323334353637");
    assert_eq!(bench.ask("601#7000000000000000"), "581#1038393A3B3C3D3E");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0B3F400000000000");
    assert_eq!(bench.ask("601#21501F0211000000"), "581#80501F0212000706");
    assert_eq!(bench.node.application.program().map(|it| it.len), Some(16));
    // A download without an announced size.
    assert_eq!(bench.ask("601#20501F0200000000"), "581#60501F0200000000");
    let mut answer = String::new();
    for at in 0..100 {
        let toggle = 0x10 * (at % 2);
        answer = bench.ask(&format!("601#{toggle:02X}01020304050607"));
        if answer.starts_with("581#80") {
            break;
        }
    }
    assert_eq!(answer, "581#80501F0212000706");
    assert_eq!(bench.node.application.program(), None);
}

#[test]
fn a_busy_memory_is_reported_until_it_is_ready() {
    let mut bench = bench(Chip::default());
    load(&mut bench);
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0200000000");
    bench.node.application.memory.busy_until = Some(Instant::from_millis(30));
    bench.change();
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0201000000");
    for command in ["01", "02", "03"] {
        let answer = bench.ask(&format!("601#2F511F02{command}000000"));
        assert_eq!(answer, "581#80511F0222000008");
    }
    assert_eq!(bench.ask("601#2F511F0200000000"), "581#60511F0200000000");
    assert_eq!(bench.node.poll_timeout(), Some(Instant::from_millis(30)));
    bench.wait(30);
    assert_eq!(bench.ask("601#40571F0200000000"), "581#43571F0200000000");
    assert_eq!(bench.ask("601#2F511F0201000000"), "581#60511F0200000000");
    assert_eq!(bench.ask("601#2F511F0203000000"), "581#80511F0222000008");
    assert_eq!(bench.ask("601#2F511F0204000000"), "581#80511F0230000906");
    assert_eq!(bench.ask("601#21501F0209000000"), "581#80501F0222000008");
    assert_eq!(bench.ask("601#2F511F0200000000"), "581#60511F0200000000");
    // A download in progress is busy, too.
    assert_eq!(bench.ask("601#21501F0209000000"), "581#60501F0200000000");
    assert_eq!(bench.node.poll_timeout(), None);
    assert_eq!(bench.node.application.program(), None);
    assert_eq!(bench.value(0x1F57, 2) & 1, 1);
    bench.send("601#80501F0200000008");
    assert_eq!(bench.value(0x1F57, 2) & 1, 0);
}

#[test]
fn a_busy_memory_delays_a_download() {
    let mut bench = bench(Chip::default());
    let ms = Instant::from_millis;
    bench.node.application.memory.busy_until = Some(ms(30));
    assert_eq!(bench.send("601#21501F0209000000"), [""; 0]);
    assert_eq!(bench.wait(29), []);
    assert_eq!(bench.wait(1), [(30, "581#60501F0200000000".to_owned())]);
    assert_eq!(bench.ask("601#0031323334353637"), "581#2000000000000000");
    bench.node.application.memory.busy_until = Some(ms(50));
    assert_eq!(bench.send("601#1B38390000000000"), [""; 0]);
    assert!(bench.node.application.memory.pages.is_empty());
    assert_eq!(bench.wait(20), [(50, DONE.to_owned())]);
    bench.node.application.memory.busy_until = Some(ms(70));
    let start = bench.ask("601#40501F0200000000");
    assert_eq!(start, "581#41501F0209000000");
    assert_eq!(bench.send("601#6000000000000000"), [""; 0]);
    let first = "581#0031323334353637".to_owned();
    assert_eq!(bench.wait(20), [(70, first)]);
}
