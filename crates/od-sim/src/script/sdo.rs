//! The SDO client of `sdo read` and `sdo write`.

use std::format;
use std::prelude::v1::*;

use od_client::sdo::{Channel, Options};
use od_client::{Client, Event, Job, lss};
use od_model::{DataType, values};
use od_wire::{AbortReason, CanId, Frame, NodeId};

use super::run::{Result, Runner, failed, impossible};
use crate::grammar::action::Outcome;
use crate::grammar::named_frame::{Write, resolve};
use crate::words::value_text;

/// A script uses segmented transfers for values of any length.
const SDO: Options = Options::SEGMENTED;

/// Result of a transfer: data, or an abort code.
type Transfer = core::result::Result<Vec<u8>, u32>;

impl Runner<'_> {
    pub(super) fn read(&mut self, object: &str, outcome: &Outcome) -> Result<()> {
        let dictionary = self.device()?.dictionary();
        let (address, data_type) = resolve(dictionary, object).or_else(impossible)?;
        let result = self.transfer(|client, node| client.read(node, address))?;
        let data_type = data_type.unwrap_or(DataType::Domain);
        let device = self.device()?;
        let shown = |bytes: &[u8]| value_text(device, address, data_type, bytes);
        let read = |bytes: &[u8]| format!("{} was read", shown(bytes));
        let done = ended(outcome, result, &format!("a value of {object}"), read)?;
        if let (Outcome::Value(value), Some(bytes)) = (outcome, done) {
            let wanted = values::parse(data_type, value).or_else(impossible)?;
            if wanted != bytes {
                return failed(format!("{object} = {}", shown(&wanted)), read(&bytes));
            }
        }
        self.progress.held += 1;
        Ok(())
    }

    pub(super) fn write(&mut self, write: &Write, outcome: &Outcome) -> Result<()> {
        let dictionary = self.device()?.dictionary();
        let (address, bytes) = write.bytes(dictionary).or_else(impossible)?;
        let result = self.transfer(|client, node| client.write(node, address, &bytes))?;
        let expected = format!("a confirmed write of {}", write.object);
        ended(outcome, result, &expected, |_| {
            "the value was written".into()
        })?;
        self.progress.held += 1;
        Ok(())
    }

    /// Carries out one transfer; a download returns no bytes.
    fn transfer(&mut self, begin: impl FnOnce(&mut Client, NodeId) -> Job) -> Result<Transfer> {
        let mut client = Client::with(SDO, lss::Options::DEFAULT);
        begin(&mut client, self.device()?.node_id());
        loop {
            match self.next_event(&mut client)? {
                Event::Read(_, result) => return transferred(result),
                Event::Written(_, result) => return transferred(result.map(|()| Vec::new())),
                _ => {}
            }
        }
    }

    /// Runs the client until an event. It receives the responses among the frames
    /// after its request; other frames stay for `expect`.
    fn next_event(&mut self, client: &mut Client) -> Result<Event> {
        let id = Channel::of(self.device()?.node_id()).response;
        let mut looked_at = self.progress.pending.len();
        loop {
            if let Some(event) = client.poll_event() {
                return Ok(event);
            }
            while let Some(frame) = client.poll_transmit(self.now()) {
                looked_at = self.progress.pending.len();
                self.send(&frame);
            }
            if let Some(answer) = self.answer(id, &mut looked_at) {
                client.handle_frame(self.now(), &answer);
                continue;
            }
            let until = client.poll_timeout().unwrap_or(self.now());
            if self.bench.bus.advance_until_sent(until) {
                self.advance(self.now());
            } else {
                client.handle_timeout(until);
            }
        }
    }

    /// Takes the next received frame with this CAN-ID.
    fn answer(&mut self, id: CanId, looked_at: &mut usize) -> Option<Frame> {
        while let Some(sent) = self.progress.pending.get(*looked_at) {
            if sent.frame.id() == id && !sent.frame.is_remote() {
                return self
                    .progress
                    .pending
                    .remove(*looked_at)
                    .map(|sent| sent.frame);
            }
            *looked_at += 1;
        }
        None
    }
}

/// A script may expect an abort; any other error stops the script.
fn transferred(result: core::result::Result<Vec<u8>, od_client::Error>) -> Result<Transfer> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(od_client::Error::Abort(code)) => Ok(Err(code)),
        Err(od_client::Error::Silent) => failed(
            "an SDO response",
            format!("none came within {:?}", SDO.timeout),
        ),
        Err(od_client::Error::OutOfTurn { expected, got }) => {
            failed(expected.to_string(), format!("{got:?} came"))
        }
        Err(other) => failed("an SDO transfer", other.to_string()),
    }
}

/// Compares the end of a transfer with the expected one. Returns the bytes of a successful transfer.
fn ended(
    outcome: &Outcome,
    result: Transfer,
    expected: &str,
    shown: impl Fn(&[u8]) -> String,
) -> Result<Option<Vec<u8>>> {
    match (outcome, result) {
        (Outcome::Aborts(wanted), Err(code)) if wanted.code() == code => Ok(None),
        (Outcome::Aborts(wanted), Err(code)) => {
            failed(format!("SDO abort {wanted}"), aborted(code))
        }
        (Outcome::Aborts(wanted), Ok(bytes)) => {
            failed(format!("SDO abort {wanted}"), shown(&bytes))
        }
        (_, Err(code)) => failed(expected, aborted(code)),
        (_, Ok(bytes)) => Ok(Some(bytes)),
    }
}

fn aborted(code: u32) -> String {
    format!("SDO abort {}", AbortReason(code))
}
