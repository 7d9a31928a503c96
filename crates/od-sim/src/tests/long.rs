//! Strings and DOMAINs of a device of a file: which lengths they accept, and how much memory they
//! take.

use std::prelude::v1::*;
use std::{format, vec};

use od_client::sdo::Options;
use od_client::{Client, Event, lss};
use od_model::Address;
use od_runtime::{AbortCode, Instant, NodeId};

use super::STRINGS;
use crate::device::VirtualDevice;
use crate::device::loaded::EdsOptions;

const TEXT: Address = Address::new(0x2001, 0);
const DOMAIN: Address = Address::new(0x2002, 0);
const MIB: usize = 1 << 20;

/// A device and its master, on a bus of their own.
struct Pair {
    device: VirtualDevice,
    client: Client,
    now: Instant,
}

fn pattern(len: usize) -> Vec<u8> {
    (0..len).map(|at| (at * 31 % 251) as u8).collect()
}

fn abort<T>(code: AbortCode) -> Result<T, od_client::Error> {
    Err(od_client::Error::Abort(code.code()))
}

impl Pair {
    fn new(eds: &str, size: Option<u32>, options: Options) -> Self {
        let options_of_device = EdsOptions {
            node_id: Some(NodeId::ONE),
            lenient: true,
        };
        let device = VirtualDevice::from_eds(eds, options_of_device);
        let mut device = device.unwrap_or_else(|findings| panic!("{findings:?}"));
        assert!(size.is_none_or(|size| device.set_domain_size(size)));
        device.power_on(Instant::ZERO);
        while device.poll_transmit(Instant::ZERO).is_some() {}
        Self {
            device,
            client: Client::with(options, lss::Options::DEFAULT),
            now: Instant::ZERO,
        }
    }

    fn event(&mut self) -> Event {
        loop {
            let now = self.now;
            if let Some(frame) = self.device.poll_transmit(now) {
                self.client.handle_frame(now, &frame);
            } else if let Some(frame) = self.client.poll_transmit(now) {
                self.device.handle_frame(now, &frame);
            } else if let Some(event) = self.client.poll_event() {
                return event;
            } else {
                self.now = self.client.poll_timeout().expect("a deadline");
                self.client.handle_timeout(self.now);
                self.device.handle_timeout(self.now);
            }
        }
    }

    fn write(&mut self, object: Address, value: &[u8]) -> Result<(), od_client::Error> {
        self.client.write(NodeId::ONE, object, value);
        match self.event() {
            Event::Written(_, result) => result,
            event => panic!("{event:?}"),
        }
    }

    /// The value in the form of an SDO and of the bench.
    fn read(&mut self, object: Address) -> Vec<u8> {
        self.client.read(NodeId::ONE, object);
        let Event::Read(_, Ok(value)) = self.event() else {
            panic!("{object} cannot be read");
        };
        let shown = self.device.read(object, self.now);
        assert!(shown == value, "{} and {} bytes", shown.len(), value.len());
        value
    }

    fn command(&mut self, index: u16, signature: &[u8]) {
        assert_eq!(self.write(Address::new(index, 1), signature), Ok(()));
    }

    fn power_cycle(&mut self) {
        self.device.power_off(self.now);
        self.device.power_on(self.now);
        while self.device.poll_transmit(self.now).is_some() {}
    }

    /// Number of bytes of its values.
    fn memory(&self) -> usize {
        let node = &self.device.node;
        let parts = node.application.file_parts.as_ref();
        node.values().len() + parts.map_or(0, |parts| parts.long.memory())
    }
}

fn blocks() -> Options {
    let mut options = Options::DEFAULT;
    options.block_from = Some(0);
    options.block_upload = true;
    options
}

/// Adds objects: their sections, and their lines in the list.
fn with(objects: &[(u16, String)]) -> String {
    let mut eds = STRINGS.replace(
        "SupportedObjects=7",
        &format!("SupportedObjects={}", 7 + objects.len()),
    );
    for (number, (index, section)) in (8..).zip(objects) {
        eds = eds.replace("7=0x2013\n", &format!("7=0x2013\n{number}={index:#06X}\n"));
        eds += &format!("\n[{index:04X}]\n{section}");
    }
    eds
}

#[test]
fn values_of_every_length_in_both_directions() {
    for options in [Options::SEGMENTED, blocks()] {
        let mut pair = Pair::new(STRINGS, None, options);
        // From long to short and back; each value has its own length.
        for len in [0, 1, 4, 5, 7, 8, 889, 890, 1024, 1025, 65_536, 7, 65_533, 0] {
            assert_eq!(pair.write(DOMAIN, &pattern(len)), Ok(()), "{len}");
            assert!(pair.read(DOMAIN) == pattern(len), "{len}");
        }
    }
}

#[test]
fn a_domain_takes_one_mebibyte_and_a_string_what_the_file_says() {
    let mut pair = Pair::new(STRINGS, None, blocks());
    assert_eq!(pair.write(DOMAIN, &pattern(MIB)), Ok(()));
    assert!(pair.read(DOMAIN) == pattern(MIB));
    assert_eq!(
        pair.write(DOMAIN, &pattern(MIB + 1)),
        abort(AbortCode::TooLong)
    );
    let shown = pair.device.read(DOMAIN, pair.now);
    assert!(shown == pattern(MIB), "all or nothing");
    assert_eq!(pair.write(TEXT, &[b'a'; 64]), Ok(()));
    assert_eq!(pair.write(TEXT, &[b'b'; 65]), abort(AbortCode::TooLong));
    assert_eq!(pair.read(TEXT), [b'a'; 64]);
}

#[test]
fn the_size_applies_to_strings_and_domains() {
    for (size, options) in [(1025, blocks()), (1025, Options::SEGMENTED), (2, blocks())] {
        let mut pair = Pair::new(STRINGS, Some(size), options);
        let size = size as usize;
        // The text has a default of three bytes.
        for (object, limit) in [(DOMAIN, size), (TEXT, size.max(3))] {
            for len in [limit, limit + 1] {
                let expected = if len > limit {
                    abort(AbortCode::TooLong)
                } else {
                    Ok(())
                };
                assert_eq!(pair.write(object, &pattern(len)), expected, "{len}");
                assert!(pair.read(object) == pattern(limit));
            }
        }
    }
    let mut built_in = super::gxmm(1);
    assert!(!built_in.set_domain_size(5));
}

#[test]
fn a_long_value_is_lost_after_a_reset() {
    let command = "ParameterName=x\nObjectType=8\nSubNumber=2\n";
    let command = |index: u16| {
        format!(
            "{command}[{index:04X}sub0]\nParameterName=n\nDataType=5\nAccessType=const\nDefaultValue=1\n\
             [{index:04X}sub1]\nParameterName=1\nDataType=7\nAccessType=rw\n"
        )
    };
    let eds = with(&[0x1010, 0x1011].map(|index| (index, command(index))));
    let eds = eds.replace(
        "AccessType=rw\nDefaultValue=\n",
        "AccessType=rw\nDefaultValue=0102\n",
    );
    let mut pair = Pair::new(&eds, None, blocks());
    assert_eq!(pair.write(DOMAIN, &pattern(1024)), Ok(()));
    pair.command(0x1010, b"save");
    assert_eq!(pair.write(DOMAIN, &pattern(2000)), Ok(()));
    // The value saved by 1010h stays, and the longer value is not saved.
    pair.power_cycle();
    assert!(pair.read(DOMAIN) == pattern(1024), "of 1,024 bytes it is");
    assert_eq!(pair.write(DOMAIN, &pattern(2000)), Ok(()));
    pair.command(0x1010, b"save");
    assert!(pair.read(DOMAIN) == pattern(2000));
    pair.device
        .handle_frame(pair.now, &super::frame("000#8201"));
    while pair.device.poll_transmit(pair.now).is_some() {}
    assert!(
        pair.read(DOMAIN) == pattern(2000),
        "reset communication leaves it"
    );
    pair.device
        .handle_frame(pair.now, &super::frame("000#8101"));
    while pair.device.poll_transmit(pair.now).is_some() {}
    assert_eq!(pair.read(DOMAIN), b"\x01\x02", "the default");
}

#[test]
fn memory_is_allocated_when_a_value_is_written() {
    let domain = "ParameterName=Domain\nObjectType=2\nDataType=0xF\nAccessType=rw\n";
    let domains: Vec<_> = (0x3000..0x30C8)
        .map(|index| (index, domain.into()))
        .collect();
    let mut pair = Pair::new(&with(&domains), Some(MIB as u32), blocks());
    let before = pair.memory();
    assert!(before < 300_000, "{before} bytes for 200 empty DOMAINs");
    let object = Address::new(0x3000, 0);
    assert_eq!(pair.write(object, &pattern(MIB)), Ok(()));
    assert_eq!(pair.memory(), before + MIB);
    assert_eq!(
        pair.write(object, &pattern(MIB + 1)),
        abort(AbortCode::TooLong)
    );
    assert_eq!(pair.memory(), before + MIB);
    // An interrupted transfer leaves nothing.
    let job = pair.client.write(NodeId::ONE, object, &pattern(50_000));
    for _ in 0..1000 {
        if let Some(frame) = pair.device.poll_transmit(pair.now) {
            pair.client.handle_frame(pair.now, &frame);
        } else if let Some(frame) = pair.client.poll_transmit(pair.now) {
            pair.device.handle_frame(pair.now, &frame);
        }
    }
    assert!(pair.memory() > before + MIB);
    assert!(pair.client.cancel(pair.now, job));
    while let Some(frame) = pair.client.poll_transmit(pair.now) {
        pair.device.handle_frame(pair.now, &frame);
    }
    assert_eq!(pair.memory(), before + MIB);
    assert_eq!(pair.write(object, &[1]), Ok(()));
    assert_eq!((pair.read(object), pair.memory()), (vec![1], before));
}

#[test]
fn a_default_may_be_longer_than_the_limit() {
    let bytes = pattern(70_000);
    let hex: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    for access in ["ro", "const", "rw"] {
        let eds = STRINGS.replace(
            "DataType=0x000F\nAccessType=rw\nDefaultValue=",
            &format!("DataType=0x000F\nAccessType={access}\nDefaultValue={hex}"),
        );
        let mut pair = Pair::new(&eds, Some(100), blocks());
        assert!(pair.read(DOMAIN) == bytes, "{access}");
        if access == "rw" {
            assert_eq!(
                pair.write(DOMAIN, &pattern(70_001)),
                abort(AbortCode::TooLong)
            );
            assert_eq!(pair.write(DOMAIN, b"abc"), Ok(()));
            assert_eq!(pair.read(DOMAIN), b"abc");
            pair.power_cycle();
            assert!(pair.read(DOMAIN) == bytes, "after a start");
        }
    }
}
