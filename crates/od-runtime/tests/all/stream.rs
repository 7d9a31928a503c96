//! Values that an application streams. `crates/odkit/tests/boot_loader.rs` tests the transfers of a
//! boot loader; this file tests the rest.

use crate::support::{Bench, rows};
use od_model::Address;
use od_runtime::{AbortCode, Application, Chunk, Context, Halt, Instant, Stream, StreamEnd};

/// 2002h and 2003h are streamed; everything else is in the store.
#[derive(Default)]
struct Pipe {
    value: Vec<u8>,
    /// Result of every call, if there is one.
    halt: Option<Halt>,
    /// Result of every write and read, if there is one; a transfer can begin.
    is_full: Option<Halt>,
    chunks: Vec<usize>,
    /// Every read: position and length.
    reads: Vec<(u32, usize)>,
    ends: Vec<StreamEnd>,
    /// The stream no longer exists.
    is_gone: bool,
}

impl Pipe {
    fn gate(&self) -> Result<(), Halt> {
        self.halt.map_or(Ok(()), Err)
    }
}

impl Stream for Pipe {
    fn begin_download(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        _: Option<u32>,
    ) -> Result<(), Halt> {
        self.gate()?;
        self.value.clear();
        Ok(())
    }

    fn write(&mut self, _: &mut Context<'_, '_>, _: Address, chunk: Chunk<'_>) -> Result<(), Halt> {
        self.gate()?;
        self.is_full.map_or(Ok(()), Err)?;
        assert_eq!(chunk.at as usize, self.value.len());
        self.value.extend_from_slice(chunk.bytes);
        self.chunks.push(chunk.bytes.len());
        Ok(())
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        self.gate()?;
        Ok(self.value.len() as u32)
    }

    fn read(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        self.gate()?;
        self.reads.push((at, to.len()));
        to.copy_from_slice(&self.value[at as usize..][..to.len()]);
        Ok(())
    }

    fn end(&mut self, _: &mut Context<'_, '_>, _: Address, end: StreamEnd) {
        self.ends.push(end);
    }
}

impl Application for Pipe {
    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        let is_streamed = matches!(address.index, 0x2002 | 0x2003) && !self.is_gone;
        if is_streamed { Some(self) } else { None }
    }
}

fn bench(len: usize) -> Bench<Pipe> {
    let value = (0..len).map(|at| (at * 31 % 251) as u8).collect();
    let pipe = Pipe {
        value,
        ..Pipe::default()
    };
    let mut bench = Bench::with(rows(), pipe);
    bench.power_on();
    bench
}

#[test]
fn a_string_is_streamed_like_a_domain() {
    let mut bench = bench(9);
    assert_eq!(bench.ask("601#4002200000000000"), "581#4102200009000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#00001F3E5D7C9BBA");
    assert_eq!(bench.ask("601#7000000000000000"), "581#1BD9F80000000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#8000000001000405");
    assert_eq!(bench.node.application.ends, [StreamEnd::Complete]);
    assert_eq!(
        bench.ask("601#4008100000000000"),
        "581#4108100011000000",
        "the store has this one"
    );
}

#[test]
fn parts_are_no_longer_than_the_buffer() {
    // The buffer has 512 bytes: blocks of 73 segments. A rest smaller than a segment is sent first.
    let mut bench = bench(0);
    bench.ask("601#2003200000000000");
    for at in 0..100 {
        let toggle = 0x10 * (at % 2);
        bench.ask(&format!("601#{toggle:02X}01020304050607"));
    }
    bench.ask("601#0F00000000000000");
    assert_eq!(bench.node.application.chunks, [511, 189]);
    assert_eq!(bench.ask("601#A403200000000000"), "581#8003200002000405");
    bench.node.application.reads.clear();
    assert_eq!(bench.ask("601#A40320007F000000"), "581#C6032000BC020000");
    assert_eq!(bench.send("601#A300000000000000").len(), 100);
    assert_eq!(bench.node.application.reads, [(0, 512), (511, 189)]);
    // The master received ten of them. The others are sent again, and the CRC includes each byte
    // once.
    assert_eq!(bench.send("601#A20A7F0000000000").len(), 90);
    assert_eq!(bench.node.application.reads[2..], [(70, 512), (581, 119)]);
    let crc = od_wire::sdo::crc16(&bench.node.application.value).to_le_bytes();
    let end = format!("581#C1{:02X}{:02X}0000000000", crc[0], crc[1]);
    assert_eq!(bench.ask("601#A25A7F0000000000"), end);
    assert!(bench.send("601#A100000000000000").is_empty());
    assert_eq!(
        bench.node.application.ends.last(),
        Some(&StreamEnd::Complete)
    );
}

#[test]
fn a_stream_that_waits_is_asked_again_after_a_change() {
    let mut bench = bench(9);
    bench.node.application.halt = Some(Halt::Until(Instant::MAX));
    assert!(bench.send("601#4003200000000000").is_empty());
    assert!(bench.change().is_empty(), "still not");
    assert!(bench.wait(60_000).is_empty());
    bench.node.application.halt = None;
    assert_eq!(bench.change(), ["581#4103200009000000"]);
    // A segment waits as the first response did.
    bench.node.application.halt = Some(Halt::Until(Instant::MAX));
    assert!(bench.send("601#6000000000000000").is_empty());
    bench.node.application.halt = None;
    assert_eq!(bench.change(), ["581#00001F3E5D7C9BBA"]);
    assert!(bench.change().is_empty());
}

#[test]
fn a_block_pauses_while_the_stream_has_no_bytes() {
    let mut bench = bench(20);
    bench.ask("601#A40320007F000000");
    let later = bench.now.plus_millis(30);
    bench.node.application.halt = Some(Halt::Until(later));
    assert!(bench.send("601#A300000000000000").is_empty());
    assert_eq!(bench.wait(29), []);
    bench.node.application.halt = None;
    let frames = bench.wait(1);
    assert_eq!(frames.len(), 3);
    assert_eq!(frames[0], (30, "581#01001F3E5D7C9BBA".into()));
    // The five seconds of the master begin here.
    let abort = "581#8003200000000405".into();
    assert_eq!(bench.wait(6000), [(5030, abort)]);
    assert_eq!(
        bench.node.application.ends,
        [StreamEnd::Aborted(AbortCode::Timeout)]
    );
}

#[test]
fn a_stream_can_fail_at_each_step() {
    let refused = Some(Halt::Abort(AbortCode::Hardware));
    let code = "00000606";
    for begin in [
        "4003200000000000",
        "A40320007F000000",
        "2103200005000000",
        "C203200005000000",
        "2F03200005000000",
    ] {
        let mut bench = bench(9);
        bench.node.application.halt = refused;
        let answer = bench.ask(&format!("601#{begin}"));
        assert_eq!(answer, format!("581#80032000{code}"), "{begin}");
        assert_eq!(bench.node.application.ends, [], "nothing had begun");
    }
    for (begin, next) in [
        ("4003200000000000", "6000000000000000"),
        ("A40320007F000000", "A300000000000000"),
        ("2103200005000000", "0501020304050000"),
    ] {
        let mut bench = bench(9);
        bench.ask(&format!("601#{begin}"));
        bench.node.application.halt = refused;
        let answer = bench.ask(&format!("601#{next}"));
        assert_eq!(answer, format!("581#80032000{code}"), "{begin}");
        let failed = StreamEnd::Aborted(AbortCode::Hardware);
        assert_eq!(bench.node.application.ends, [failed]);
    }
    let mut bench = bench(9);
    bench.ask("601#4003200000000000");
    bench.node.application.is_gone = true;
    assert_eq!(bench.ask("601#6000000000000000"), "581#8003200023000A06");
}

#[test]
fn the_newest_request_gets_a_response_when_a_stream_continues() {
    let mut bench = bench(9);
    bench.ask("601#2103200005000000");
    bench.node.application.halt = Some(Halt::Until(bench.now.plus_millis(10)));
    assert!(bench.send("601#0501020304050000").is_empty());
    // The master did not wait.
    assert!(bench.send("601#4000100000000000").is_empty());
    assert_eq!(bench.wait(10), [(10, "581#4300100096010200".into())]);
    assert_eq!(bench.node.application.ends, [StreamEnd::Replaced]);
}

/// 2002h and 2003h are two values, even while the first one waits.
#[test]
fn an_expedited_download_to_another_object_replaces_one_that_waits() {
    let mut bench = bench(0);
    bench.node.application.is_full = Some(Halt::Until(bench.now.plus_millis(10)));
    assert!(bench.send("601#2F03200011000000").is_empty());
    assert_eq!(bench.node.application.ends, [], "it has begun");
    assert!(bench.send("601#2F02200022000000").is_empty());
    bench.node.application.is_full = None;
    assert_eq!(bench.wait(10), [(10, "581#6002200000000000".into())]);
    assert_eq!(bench.node.application.value, [0x22]);
    assert_eq!(
        bench.node.application.ends,
        [StreamEnd::Replaced, StreamEnd::Complete]
    );
}

#[test]
fn a_family_without_segmented_transfers_has_none_for_a_stream() {
    let mut bench = bench(5);
    bench.node.device_mut().profile.sdo.segmented_upload = false;
    assert_eq!(bench.ask("601#4003200000000000"), "581#8003200000000106");
    bench.node.application.value.truncate(4);
    assert_eq!(bench.ask("601#4003200000000000"), "581#43032000001F3E5D");
}
