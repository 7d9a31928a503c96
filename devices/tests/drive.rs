//! The drive: frames in, frames out, and the world around its shafts.

use std::iter;

use od_devices::drive::{Drive, drive};
use odkit::storage::NoStorage;
use odkit::{BusEvent, CanId, Frame, Instant, Node, NodeId};

/// Units in a revolution.
const REVOLUTION: i64 = 10_000;

struct Bench {
    node: drive::Node<Drive>,
    now: Instant,
    /// Frames of the drive since the last call, without SDO responses.
    heard: Vec<String>,
    /// Added to the indices of all objects: 800h for the second axis.
    base: u16,
}

impl Bench {
    fn new() -> Self {
        let mut bench = Self {
            node: Node::new(drive::Device, NodeId::ONE, Drive::new(), NoStorage),
            now: Instant::ZERO,
            heard: Vec::new(),
            base: 0,
        };
        bench.node.power_on(bench.now);
        bench.sent();
        bench.send(0, &[1, 0]);
        bench
    }

    /// A drive in Operation enabled with this mode.
    fn enabled(mode: u8) -> Self {
        let mut bench = Self::new();
        bench.enable(mode);
        bench
    }

    fn enable(&mut self, mode: u8) {
        self.write(0x6060, 0, &[mode]);
        for (word, state) in [(6, 0x21), (7, 0x23), (15, 0x27)] {
            self.control(word);
            assert_eq!(self.status() & 0x6F, state);
        }
    }

    fn sent(&mut self) -> Vec<Frame> {
        let frames: Vec<Frame> = iter::from_fn(|| self.node.poll_transmit(self.now)).collect();
        let others = frames.iter().filter(|one| one.id().raw() != 0x581);
        self.heard.extend(others.map(ToString::to_string));
        frames
    }

    fn send(&mut self, id: u16, data: &[u8]) -> Vec<Frame> {
        let frame = Frame::new(CanId::standard(id), data).expect("at most eight bytes");
        self.node.handle_frame(self.now, &frame);
        self.sent()
    }

    /// Writes an object by SDO; returns the abort code if it is refused.
    fn try_write(&mut self, index: u16, sub: u8, bytes: &[u8]) -> Option<u32> {
        let mut data = [0; 8];
        data[0] = 0x23 | (4 - bytes.len() as u8) << 2;
        data[1..3].copy_from_slice(&(index + self.base).to_le_bytes());
        data[3] = sub;
        data[4..4 + bytes.len()].copy_from_slice(bytes);
        let sent = self.send(0x601, &data);
        let response = sent.iter().find(|one| one.id().raw() == 0x581);
        let response = response.expect("a response").data();
        let code = u32::from_le_bytes(response[4..8].try_into().expect("four bytes"));
        (response[0] == 0x80).then_some(code)
    }

    #[track_caller]
    fn write(&mut self, index: u16, sub: u8, bytes: &[u8]) {
        assert_eq!(self.try_write(index, sub, bytes), None, "{index:04X}h");
    }

    #[track_caller]
    fn write32(&mut self, index: u16, value: i32) {
        self.write(index, 0, &value.to_le_bytes());
    }

    fn read(&mut self, index: u16) -> i64 {
        let [low, high] = (index + self.base).to_le_bytes();
        let sent = self.send(0x601, &[0x40, low, high, 0, 0, 0, 0, 0]);
        let response = sent.iter().find(|one| one.id().raw() == 0x581);
        let data = response.expect("a response").data();
        let value = i32::from_le_bytes(data[4..8].try_into().expect("four bytes"));
        match data[0] {
            0x4F => (value as i8).into(),
            0x4B => (value as u16).into(),
            _ => value.into(),
        }
    }

    fn control(&mut self, word: u16) {
        self.write(0x6040, 0, &word.to_le_bytes());
    }

    fn status(&mut self) -> u16 {
        self.read(0x6041) as u16
    }

    /// Waits until bits of the statusword are set; returns the number of milliseconds.
    #[track_caller]
    fn until(&mut self, bits: u16) -> u64 {
        for millis in 0..60_000 {
            if self.status() & bits == bits {
                return millis;
            }
            self.wait(1);
        }
        let (status, place) = (self.status(), self.read(0x6064));
        panic!("{bits:04X}h does not come: {status:04X}h at {place}");
    }

    fn wait(&mut self, millis: u64) {
        let end = self.now.plus_millis(millis);
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
            self.now = at;
            self.node.handle_timeout(at);
            self.sent();
        }
        self.now = end;
    }

    /// Waits in steps of a millisecond, with switches that follow the shaft: a limit switch beyond −20 and
    /// 20 revolutions, and a home switch from 5 to 10 revolutions.
    fn wait_with_switches(&mut self, millis: u64) {
        let axis = usize::from(self.base / 0x800);
        for _ in 0..millis {
            self.node.change(self.now, |drive, _| {
                let turns = drive.shaft(axis).expect("an axis") >> 32;
                let world = drive.world(axis).expect("an axis");
                world.negative_limit = turns < -20;
                world.positive_limit = turns >= 20;
                world.home = (5..10).contains(&turns);
            });
            self.wait(1);
        }
    }

    fn heard(&mut self) -> Vec<String> {
        std::mem::take(&mut self.heard)
    }
}

const REACHED: u16 = 1 << 10;
const LIMIT: u16 = 1 << 11;
const ACKNOWLEDGED: u16 = 1 << 12;
const ERROR: u16 = 1 << 13;

#[test]
fn every_command_has_the_effect_of_cia_402() {
    const DISABLED: u16 = 0x40;
    const READY: u16 = 0x21;
    const ON: u16 = 0x23;
    const ENABLED: u16 = 0x27;
    const STOP: u16 = 0x07;
    // The commands that lead to a state, a command there, and the state after it.
    for (path, command, state) in [
        (&[][..], 0x06, READY),
        (&[], 0x07, DISABLED),
        (&[], 0x0F, DISABLED),
        (&[], 0x00, DISABLED),
        (&[6], 0x07, ON),
        (&[6], 0x0F, ENABLED),
        (&[6], 0x00, DISABLED),
        (&[6], 0x02, DISABLED),
        (&[6, 7], 0x0F, ENABLED),
        (&[6, 7], 0x06, READY),
        (&[6, 7], 0x00, DISABLED),
        (&[6, 7], 0x02, DISABLED),
        (&[6, 7, 15], 0x07, ON),
        (&[6, 7, 15], 0x06, READY),
        (&[6, 7, 15], 0x00, DISABLED),
        (&[6, 7, 15], 0x02, STOP),
        (&[6, 7, 15, 2], 0x0F, ENABLED),
        (&[6, 7, 15, 2], 0x06, STOP),
        (&[6, 7, 15, 2], 0x00, DISABLED),
    ] {
        let mut bench = Bench::new();
        bench.write(0x605A, 0, &[6, 0]);
        for word in path {
            bench.control(*word);
            bench.wait(2);
        }
        bench.control(command);
        bench.wait(2);
        let mask = if state == DISABLED { 0x4F } else { 0x6F };
        assert_eq!(bench.status() & mask, state, "{path:?}, {command:02X}h");
    }
}

/// Transition 16 waits for the end of the stop.
#[test]
fn a_command_during_a_stop_counts_after_it() {
    let mut bench = Bench::enabled(3);
    bench.write(0x605A, 0, &[6, 0]);
    bench.write32(0x60FF, 100_000);
    bench.until(REACHED);
    bench.control(0x02);
    bench.write32(0x60FF, 0);
    bench.control(0x0F);
    assert_eq!(bench.status() & 0x6F, 0x07);
    bench.wait(12);
    assert_eq!(bench.status() & 0x6F, 0x27);
}

#[test]
fn a_set_point_is_acknowledged_and_reached_and_the_next_one_follows() {
    let mut bench = Bench::enabled(1);
    bench.write32(0x607A, 50_000);
    bench.control(0x1F);
    assert_eq!(bench.status() & ACKNOWLEDGED, ACKNOWLEDGED);
    assert_eq!(bench.status() & REACHED, 0);
    bench.control(0x0F);
    assert_eq!(bench.status() & ACKNOWLEDGED, 0);
    // Into the buffer: it is acknowledged when there is room for another one.
    bench.write32(0x607A, 60_000);
    bench.control(0x1F);
    bench.control(0x0F);
    assert_eq!(bench.status() & ACKNOWLEDGED, ACKNOWLEDGED);
    // Without room it is not accepted.
    bench.write32(0x607A, 1);
    bench.control(0x1F);
    bench.control(0x0F);
    // 50,000 units with 100,000 units/s and 1,000,000 units/s²: 0.5 s + 0.1 s; then 0.1 s + 0.1 s.
    let millis = bench.until(REACHED);
    assert!((780..820).contains(&millis), "{millis}");
    assert_eq!(bench.read(0x6064), 60_000);
    assert_eq!(bench.status() & ACKNOWLEDGED, 0);
    assert_eq!(bench.node.application.shaft(0), Some(6 << 32));
}

#[test]
fn a_set_point_at_once_replaces_the_present_one() {
    let mut bench = Bench::enabled(1);
    bench.write32(0x607A, 500_000);
    bench.control(0x1F);
    bench.wait(300);
    bench.control(0x0F);
    // Back, relative to the last target: 500,000 - 499,000.
    bench.write32(0x607A, -499_000);
    bench.control(0x7F);
    bench.until(REACHED);
    assert_eq!(bench.read(0x6064), 1_000);
    assert_eq!(bench.read(0x60F4), 0);
}

#[test]
fn halt_stops_and_continues() {
    let mut bench = Bench::enabled(1);
    bench.write32(0x607A, 100_000);
    bench.control(0x1F);
    bench.wait(500);
    bench.control(0x11F);
    bench.wait(150);
    let place = bench.read(0x6064);
    assert!((40_000..60_000).contains(&place), "{place}");
    assert_eq!((bench.read(0x606C), bench.status() & REACHED), (0, REACHED));
    bench.wait(100);
    assert_eq!(bench.read(0x6064), place);
    bench.control(0x1F);
    bench.until(REACHED);
    assert_eq!(bench.read(0x6064), 100_000);
}

#[test]
fn software_limits_stop_a_movement() {
    let mut bench = Bench::enabled(1);
    bench.write(0x607D, 2, &20_000_i32.to_le_bytes());
    bench.write(0x607D, 1, &(-1_i32).to_le_bytes());
    bench.write32(0x607A, 30_000);
    bench.control(0x1F);
    bench.until(REACHED);
    assert_eq!(bench.read(0x6064), 20_000);
    // They stop a velocity, too; it can lead back.
    bench.enable_mode(3);
    bench.write32(0x60FF, 1_000);
    bench.wait(50);
    assert_eq!((bench.read(0x606B), bench.status() & LIMIT), (0, LIMIT));
    bench.write32(0x60FF, -10_000);
    bench.wait(50);
    assert_eq!(bench.status() & LIMIT, 0);
    assert!(bench.read(0x6064) < 20_000);
}

impl Bench {
    fn enable_mode(&mut self, mode: u8) {
        self.control(0x0F);
        self.write(0x6060, 0, &[mode]);
        assert_eq!(self.read(0x6061), i64::from(mode));
    }
}

#[test]
fn a_velocity_is_reached_by_its_ramp_and_ended_by_quick_stop() {
    let mut bench = Bench::enabled(3);
    // Bit 12: the shaft is at rest.
    bench.wait(2);
    assert_eq!(bench.status() & ACKNOWLEDGED, ACKNOWLEDGED);
    bench.write32(0x60FF, -100_000);
    let millis = bench.until(REACHED);
    assert!((95..105).contains(&millis), "{millis}");
    assert_eq!(
        (bench.read(0x606C), bench.status() & ACKNOWLEDGED),
        (-100_000, 0)
    );
    // 10,000,000 units/s²: 10 ms, then "switch on disabled".
    bench.control(0x02);
    assert_eq!(bench.status() & 0x6F, 0x07);
    bench.wait(8);
    assert_eq!(bench.status() & 0x6F, 0x07);
    bench.wait(4);
    assert_eq!(bench.status() & 0x4F, 0x40);
    assert_eq!(bench.read(0x606C), 0);
}

#[test]
fn without_torque_a_shaft_runs_out() {
    let mut bench = Bench::enabled(3);
    bench.write32(0x60FF, 100_000);
    bench.until(REACHED);
    bench.control(0x00);
    bench.wait(500);
    let speed = bench.read(0x606C);
    assert!((45_000..55_000).contains(&speed), "{speed}");
    bench.wait(600);
    assert_eq!(bench.read(0x606C), 0);
    assert_eq!(
        bench.node.poll_timeout(),
        None,
        "a drive at rest has nothing to do"
    );
}

#[test]
fn shutdown_and_disable_operation_slow_down_as_their_option_codes_say() {
    for (command, code, value, state) in [(0x06, 0x605B, 1, 0x21), (0x07, 0x605C, 1, 0x23)] {
        let mut bench = Bench::enabled(3);
        bench.write(code, 0, &[value, 0]);
        bench.write32(0x60FF, 50_000);
        bench.until(REACHED);
        bench.control(command);
        assert_eq!(bench.status() & 0x6F, 0x27);
        bench.wait(52);
        assert_eq!(bench.status() & 0x6F, state);
        assert_eq!(bench.read(0x606C), 0);
    }
}

#[test]
fn homing_finds_edges_and_index_pulses() {
    // Method, start position, and the home position before homing, in revolutions.
    for (method, begin, home) in [
        (17, 0, -20),
        (18, 0, 20),
        (1, 0, -19),
        (2, 0, 19),
        (19, 0, 5),
        (19, 7, 5),
        (20, 0, 5),
        (20, 7, 5),
        (35, 3, 3),
        (37, -4, -4),
    ] {
        let mut bench = Bench::enabled(1);
        bench.write32(0x607A, begin * REVOLUTION as i32 + 100);
        bench.control(0x1F);
        bench.wait_with_switches(1_500);
        bench.enable_mode(6);
        bench.write(0x6098, 0, &[method]);
        bench.write32(0x607C, 250);
        bench.control(0x1F);
        bench.wait_with_switches(20_000);
        let status = bench.status();
        let done = REACHED | ACKNOWLEDGED;
        assert_eq!(
            status & (done | ERROR),
            done,
            "method {method} from {begin}"
        );
        // The zero position differs from the home position by the home offset.
        let shaft = bench.node.application.shaft(0).expect("an axis");
        let turned = (i128::from(shaft) * i128::from(REVOLUTION)) >> 32;
        let found = turned as i64 - bench.read(0x6064) - 250;
        let expected = match method {
            35 | 37 => i64::from(home) * REVOLUTION + 100,
            _ => i64::from(home) * REVOLUTION,
        };
        let slack = if method < 3 { 1 } else { 15 };
        assert!(
            (found - expected).abs() <= slack,
            "method {method} from {begin}: {found}"
        );
    }
}

/// CiA 402-2, statusword in homing mode: bit 10 is 0 only while homing is in progress, or stops with an error.
#[test]
fn homing_that_is_not_in_progress_has_bit_10() {
    let mut bench = Bench::enabled(6);
    let flags = REACHED | ACKNOWLEDGED | ERROR;
    bench.wait(5);
    assert_eq!(bench.status() & flags, REACHED, "not started");
    bench.write(0x6098, 0, &[19]);
    bench.control(0x1F);
    bench.wait(200);
    assert_eq!(bench.status() & flags, 0, "in progress");
    bench.control(0x11F);
    bench.wait(5_000);
    assert_eq!(bench.status() & flags, REACHED, "interrupted by halt");
}

#[test]
fn homing_fails_at_the_wrong_switch() {
    let mut bench = Bench::enabled(6);
    bench.write(0x6098, 0, &[19]);
    bench.control(0x1F);
    bench.node.change(bench.now, |drive, _| {
        drive.world(0).expect("an axis").positive_limit = true;
    });
    bench.wait(200);
    assert_eq!(bench.status() & (ERROR | ACKNOWLEDGED), ERROR);
    assert_eq!(bench.try_write(0x6098, 0, &[3]), Some(0x0609_0030));
}

#[test]
fn cyclic_positions_are_followed_between_sync_messages() {
    let mut bench = Bench::enabled(8);
    // RPDO2 with SYNC: controlword and target.
    for step in 1..=100 {
        let [a, b, c, d] = (step * 37_i32).to_le_bytes();
        bench.send(0x301, &[0x0F, 0, a, b, c, d]);
        bench.send(0x080, &[]);
        bench.wait(1);
        assert_eq!(bench.read(0x6064), i64::from(step) * 37);
    }
    assert_eq!(bench.status() & ACKNOWLEDGED, ACKNOWLEDGED);
    assert_eq!(bench.read(0x606C), 37_000);
    let tpdo2 = bench
        .heard()
        .into_iter()
        .rev()
        .find(|one| one.starts_with("281#"));
    assert_eq!(
        tpdo2.as_deref(),
        Some("281#37124F0E0000"),
        "the position of the SYNC before"
    );
    // A target that is too far is followed at 607Fh.
    bench.send(0x301, &[0x0F, 0, 0, 0, 0, 1]);
    bench.send(0x080, &[]);
    bench.wait(1);
    assert_eq!(bench.read(0x606B), 1_000_000);
    assert_eq!(bench.status() & (LIMIT | ACKNOWLEDGED), LIMIT);
}

#[test]
fn cyclic_velocities_and_interpolated_positions() {
    let mut bench = Bench::enabled(9);
    bench.write32(0x60FF, 12_345);
    bench.wait(1000);
    assert_eq!(bench.read(0x606C), 12_345);
    bench.write32(0x60FF, 0);
    bench.wait(1);
    assert_eq!(bench.read(0x606C), 0);
    bench.enable_mode(7);
    bench.write(0x60C2, 1, &[10]);
    bench.control(0x1F);
    let place = bench.read(0x6064) as i32;
    bench.write(0x60C1, 1, &(place + 1_000).to_le_bytes());
    bench.wait(5);
    assert_eq!(bench.read(0x6064) as i32, place + 500);
    bench.wait(5);
    assert_eq!(bench.read(0x6064) as i32, place + 1_000);
    assert_eq!(
        bench.status() & (REACHED | ACKNOWLEDGED),
        REACHED | ACKNOWLEDGED
    );
}

#[test]
fn a_held_shaft_is_a_following_error_that_a_reset_ends() {
    let mut bench = Bench::enabled(1);
    bench.write(0x6065, 0, &100_u32.to_le_bytes());
    bench.write(0x6066, 0, &[40, 0]);
    bench.heard();
    bench.node.change(bench.now, |drive, _| {
        drive.world(0).expect("an axis").is_held = true;
    });
    bench.write32(0x607A, 100_000);
    bench.control(0x1F);
    bench.wait(35);
    assert_eq!(bench.status() & ERROR, 0, "before the time of 6066h");
    bench.wait(65);
    assert_eq!(bench.status() & ERROR, ERROR);
    let emcy = |bench: &mut Bench| {
        bench
            .heard()
            .into_iter()
            .find(|one| one.starts_with("081#"))
    };
    assert_eq!(emcy(&mut bench).as_deref(), Some("081#1186210100000000"));
    assert_eq!(bench.status() & 0x4F, 0x08);
    assert_eq!(bench.read(0x603F), 0x8611);
    bench.control(0x80);
    assert_eq!(bench.status() & 0x4F, 0x40);
    assert_eq!(emcy(&mut bench).as_deref(), Some("081#0000000000000000"));
    assert_eq!(bench.read(0x603F), 0);
}

#[test]
fn safe_torque_off_is_a_fault_until_it_ends() {
    let mut bench = Bench::enabled(3);
    bench.write32(0x60FF, 100_000);
    bench.until(REACHED);
    bench.heard();
    let sto = |bench: &mut Bench, on| {
        bench.node.change(bench.now, |drive, _| {
            drive.world(0).expect("an axis").is_safe = on;
        });
        bench.sent();
    };
    sto(&mut bench, true);
    assert_eq!(bench.status() & 0x4F, 0x08);
    assert!(bench.read(0x606C) > 90_000, "it runs out");
    assert!(bench.heard().contains(&"081#4154210100000000".into()));
    assert_eq!(bench.read(0x60FD), 8);
    bench.control(0x80);
    assert_eq!(bench.status() & 0x4F, 0x08);
    sto(&mut bench, false);
    bench.control(0x00);
    bench.control(0x80);
    assert_eq!(bench.status() & 0x4F, 0x40);
}

#[test]
fn the_reaction_to_a_lost_master_is_that_of_6007h() {
    for (code, state) in [(0, 0x27), (1, 0x08), (2, 0x40), (3, 0x40)] {
        let mut bench = Bench::enabled(3);
        bench.write(0x6007, 0, &[code, 0]);
        bench.node.handle_bus(bench.now, BusEvent::Off);
        bench.wait(5);
        bench.node.handle_bus(bench.now, BusEvent::Active);
        let mask = if state == 0x27 { 0x6F } else { 0x4F };
        assert_eq!(bench.status() & mask, state, "code {code}");
    }
    let mut bench = Bench::enabled(3);
    bench.send(0, &[2, 0]);
    bench.send(0, &[0x80, 0]);
    assert_eq!(bench.read(0x603F), 0x8130);
}

#[test]
fn polarity_reverses_the_direction() {
    let mut bench = Bench::enabled(1);
    bench.write(0x607E, 0, &[0xC0]);
    bench.write32(0x607A, 10_000);
    bench.control(0x1F);
    bench.wait(50);
    assert!(bench.read(0x606C) > 0);
    bench.until(REACHED);
    assert_eq!(bench.read(0x6064), 10_000);
    assert_eq!(bench.node.application.shaft(0), Some(-1 << 32));
}

#[test]
fn the_second_axis_is_800h_above() {
    let mut bench = Bench::new();
    bench.base = 0x800;
    bench.enable(1);
    bench.write32(0x607A, 20_000);
    bench.control(0x1F);
    bench.until(REACHED);
    assert_eq!(bench.node.application.shaft(1), Some(2 << 32));
    assert_eq!(bench.node.application.shaft(0), Some(0));
    bench.base = 0;
    assert_eq!(bench.status() & 0x4F, 0x40);
}

#[test]
fn values_that_are_not_supported_are_refused() {
    let mut bench = Bench::new();
    for (index, value) in [(0x6060, &[4][..]), (0x605A, &[3, 0]), (0x605D, &[3, 0])] {
        let code = bench.try_write(index, 0, value);
        assert!(
            matches!(code, Some(0x0609_0030..=0x0609_0032)),
            "{index:04X}h: {code:X?}"
        );
    }
}
