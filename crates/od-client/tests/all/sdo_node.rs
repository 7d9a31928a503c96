//! The client against the node of `od-runtime`: every kind of transfer in both directions.

use crate::support::bus::{Bus, ROOM, peer};
use crate::support::{OBJECT, pattern};
use od_client::Error;
use od_client::sdo::Options;
use od_client::{AbortCode, Client, Event, NodeId, lss};
use od_model::Address;
use od_runtime::{Profile, SdoProfile};

const SIZES: [usize; 15] = [
    0,
    1,
    4,
    5,
    7,
    8,
    63,
    64,
    127 * 7 - 1,
    127 * 7,
    127 * 7 + 1,
    1000,
    4096,
    2 * 127 * 7,
    8192,
];

fn client(options: Options) -> Client {
    Client::with(options, lss::Options::DEFAULT)
}

fn blocks(size: u8) -> Options {
    let mut options = Options::DEFAULT;
    options.block_from = Some(0);
    options.block_upload = true;
    options.block_size = size;
    options
}

/// Writes values of all sizes and reads them again.
#[track_caller]
fn round_trips(bus: &mut Bus) {
    for size in SIZES {
        let value = pattern(size);
        let written = bus.client.write(NodeId::ONE, OBJECT, &value);
        let read = bus.client.read(NodeId::ONE, OBJECT);
        let wanted = [
            Event::Written(written, Ok(())),
            Event::Read(read, Ok(value)),
        ];
        assert!(bus.run() == wanted, "{size} bytes");
    }
}

#[test]
fn all_sizes_in_segments() {
    let mut bus = Bus::one(client(Options::SEGMENTED));
    round_trips(&mut bus);
    let mut segments = 0;
    for text in &bus.frames {
        let command = u8::from_str_radix(&text[4..6], 16).expect("hex");
        assert!(command >> 5 < 4, "no block transfer, no abort: {text}");
        segments += usize::from(text.starts_with("601#") && command >> 5 == 0);
    }
    let wanted = SIZES.iter().filter(|size| !(1..=4).contains(*size));
    let wanted: usize = wanted.map(|size| size.div_ceil(7).max(1)).sum();
    assert_eq!(segments, wanted);
}

/// Only the client has the whole value; the device streams it.
#[test]
fn one_mebibyte_in_blocks_in_both_directions() {
    const LONG: Address = Address::new(0x2004, 0);
    let value = pattern(1 << 20);
    let mut bus = Bus::one(client(blocks(127)));
    let written = bus.client.write(NodeId::ONE, LONG, &value);
    let read = bus.client.read(NodeId::ONE, LONG);
    let events = bus.run();
    let [Event::Written(w, Ok(())), Event::Read(r, Ok(back))] = &events[..] else {
        panic!("{} events", events.len());
    };
    assert_eq!((*w, *r, back.len()), (written, read, value.len()));
    assert!(*back == value && back.capacity() <= 2 * value.len());
    // A block of 127 segments, or the buffer.
    assert!(bus.peers[0].application.largest <= ROOM);
    // One byte more is not even requested.
    bus.peers[0].application.len = (1 << 20) + 1;
    bus.frames.clear();
    let read = bus.client.read(NodeId::ONE, LONG);
    assert_eq!(bus.run(), [Event::Read(read, Err(Error::TooLong))]);
    assert_eq!(bus.frames.len(), 3);
}

#[test]
fn long_downloads_go_in_blocks_and_an_upload_is_one_transfer() {
    let mut bus = Bus::one(client(Options::DEFAULT));
    round_trips(&mut bus);
    let begun = |head: &str| {
        bus.frames
            .iter()
            .filter(|text| text.starts_with(head))
            .count()
    };
    let long = SIZES.iter().filter(|size| **size >= 64).count();
    assert_eq!(begun("601#C6032000"), long, "block downloads");
    assert_eq!(begun("601#A4032000"), 0, "block uploads");
    assert_eq!(begun("601#80"), 0, "aborts");
    assert_eq!(begun("601#40032000"), SIZES.len(), "uploads");
}

#[test]
fn all_sizes_in_blocks_of_every_length() {
    for size in [1, 2, 3, 126, 127] {
        round_trips(&mut Bus::one(client(blocks(size))));
    }
}

#[test]
fn block_sizes_out_of_range_are_the_nearest_ones() {
    for size in [0, 128, 255] {
        round_trips(&mut Bus::one(client(blocks(size))));
    }
}

#[test]
fn segments_that_the_bus_loses_are_sent_again() {
    let mut bus = Bus::one(client(blocks(20)));
    // Only segments inside a block are lost, since the node cannot detect a lost end of a block.
    bus.loses = |number, frame| {
        let head = frame.data()[0];
        let is_segment = matches!(head, 1..=19) && frame.data()[1..] != [0; 7];
        is_segment && number.wrapping_mul(0x9E37_79B1) as u32 >> 28 == 0
    };
    round_trips(&mut bus);
}

#[test]
fn a_node_without_block_transfers_gets_segments_and_one_block_request() {
    let mut peer = peer(1, [1, 2, 3, 4]);
    peer.device_mut().profile.sdo = SdoProfile {
        block: false,
        ..Profile::CIA301.sdo
    };
    let mut bus = Bus::new(client(Options::DEFAULT), vec![peer]);
    round_trips(&mut bus);
    let blocks = |text: &&String| text.starts_with("601#C") || text.starts_with("601#A");
    assert_eq!(bus.frames.iter().filter(blocks).count(), 1);
}

#[test]
fn an_upload_also_shows_that_a_node_has_no_block_transfers() {
    let mut peer = peer(1, [1, 2, 3, 4]);
    peer.device_mut().profile.sdo.block = false;
    let mut bus = Bus::new(client(blocks(127)), vec![peer]);
    for _ in 0..2 {
        let job = bus.client.read(NodeId::ONE, OBJECT);
        assert_eq!(bus.run(), [Event::Read(job, Ok(vec![0; 8192]))]);
    }
    let blocks = bus.frames.iter().filter(|text| text.starts_with("601#A"));
    assert_eq!(blocks.count(), 1);
}

#[test]
fn aborts_of_the_node_come_with_their_code() {
    let mut bus = Bus::one(Client::new());
    let missing = bus.client.read(NodeId::ONE, Address::new(0x3000, 0));
    let constant = bus
        .client
        .write(NodeId::ONE, Address::new(0x1000, 0), &[1, 0, 0, 0]);
    let long = bus.client.write(NodeId::ONE, OBJECT, &[0; 8193]);
    let abort = |code: AbortCode| Error::Abort(code.code());
    let wanted = [
        Event::Read(missing, Err(abort(AbortCode::NoObject))),
        Event::Written(constant, Err(abort(AbortCode::ReadOnly))),
        Event::Written(long, Err(abort(AbortCode::TooLong))),
    ];
    assert_eq!(bus.run(), wanted);
}

#[test]
fn without_a_node_the_transfer_ends_after_the_timeout() {
    let mut bus = Bus::new(Client::new(), Vec::new());
    let job = bus.client.read(NodeId::ONE, OBJECT);
    assert_eq!(bus.run(), [Event::Read(job, Err(Error::Silent))]);
    let wanted = ["601#4003200000000000", "601#8003200000000405"];
    assert_eq!(bus.frames, wanted);
}
