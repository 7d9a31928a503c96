//! The SDO client behind `sdo read` and `sdo write`.

use std::format;
use std::prelude::v1::*;

use od_client::sdo::{Channel, Options, SdoError};
use od_client::{Client, Event, lss};
use od_model::{Address, DataType, values};
use od_wire::{AbortCode, CanId, Frame};

use super::run::{Result, Runner, failed, impossible};
use crate::grammar::action::Outcome;
use crate::grammar::typed::{Write, resolve};

/// A script's frames are those of segmented transfers, whatever the length of a value.
const SDO: Options = Options::SEGMENTED;

/// Result of a transfer: data, or an abort code.
type Transfer<T> = core::result::Result<T, u32>;

impl Runner<'_> {
    pub(super) fn read(&mut self, object: &str, outcome: &Outcome) -> Result<()> {
        let dictionary = self.device()?.dictionary();
        let (address, data_type) = resolve(dictionary, object).or_else(impossible)?;
        let result = self.upload(address)?;
        match (outcome, result) {
            (Outcome::Done, Ok(_)) => {}
            (Outcome::Value(value), Ok(bytes)) => {
                let data_type = data_type.unwrap_or(DataType::Domain);
                let wanted = values::parse(data_type, value).or_else(impossible)?;
                if wanted != bytes {
                    return failed(
                        format!("{object} = {}", values::show(data_type, &wanted)),
                        format!("{} was read", values::show(data_type, &bytes)),
                    );
                }
            }
            (Outcome::Aborts(wanted), Err(code)) if wanted.code() == code => {}
            (Outcome::Aborts(wanted), Ok(bytes)) => {
                let data_type = data_type.unwrap_or(DataType::Domain);
                let got = values::show(data_type, &bytes);
                return failed(format!("SDO abort {wanted}"), format!("{got} was read"));
            }
            (Outcome::Aborts(wanted), Err(code)) => {
                return failed(format!("SDO abort {wanted}"), aborted(code));
            }
            (_, Err(code)) => return failed(format!("a value of {object}"), aborted(code)),
        }
        self.held += 1;
        Ok(())
    }

    pub(super) fn write(&mut self, write: &Write, outcome: &Outcome) -> Result<()> {
        let dictionary = self.device()?.dictionary();
        let (address, bytes) = write.bytes(dictionary).or_else(impossible)?;
        let object = &write.object;
        match (outcome, self.download(address, &bytes)?) {
            (Outcome::Aborts(wanted), Err(code)) if wanted.code() == code => {}
            (Outcome::Aborts(wanted), Err(code)) => {
                return failed(format!("SDO abort {wanted}"), aborted(code));
            }
            (Outcome::Aborts(wanted), Ok(())) => {
                return failed(format!("SDO abort {wanted}"), "the value was written");
            }
            (_, Ok(())) => {}
            (_, Err(code)) => return failed(format!("{object} can be written"), aborted(code)),
        }
        self.held += 1;
        Ok(())
    }

    fn upload(&mut self, address: Address) -> Result<Transfer<Vec<u8>>> {
        let mut client = Client::with(SDO, lss::Options::DEFAULT);
        client.read(self.device()?.node_id(), address);
        loop {
            if let Event::Read(_, result) = self.next_event(&mut client)? {
                return outcome(result);
            }
        }
    }

    fn download(&mut self, address: Address, bytes: &[u8]) -> Result<Transfer<()>> {
        let mut client = Client::with(SDO, lss::Options::DEFAULT);
        client.write(self.device()?.node_id(), address, bytes);
        loop {
            if let Event::Written(_, result) = self.next_event(&mut client)? {
                return outcome(result);
            }
        }
    }

    /// Runs the client until something happens. It gets the answers among the frames that come
    /// after its request; the rest stays for `expect`.
    fn next_event(&mut self, client: &mut Client) -> Result<Event> {
        let id = Channel::of(self.device()?.node_id()).response;
        let mut looked_at = self.pending.len();
        loop {
            if let Some(event) = client.poll_event() {
                return Ok(event);
            }
            while let Some(frame) = client.poll_transmit(self.now()) {
                looked_at = self.pending.len();
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

    /// Takes the next frame with this CAN-ID out of what came.
    fn answer(&mut self, id: CanId, looked_at: &mut usize) -> Option<Frame> {
        while let Some(sent) = self.pending.get(*looked_at) {
            if sent.frame.id() == id && !sent.frame.is_remote() {
                return self.pending.remove(*looked_at).map(|sent| sent.frame);
            }
            *looked_at += 1;
        }
        None
    }
}

/// A script may expect an abort; any other error stops it.
fn outcome<T>(result: core::result::Result<T, SdoError>) -> Result<Transfer<T>> {
    match result {
        Ok(value) => Ok(Ok(value)),
        Err(SdoError::Abort(code)) => Ok(Err(code)),
        Err(SdoError::Silent) => failed(
            "an SDO answer",
            format!("none came within {:?}", SDO.timeout),
        ),
        Err(SdoError::OutOfTurn { expected, got }) => {
            failed(expected.to_string(), format!("{got:?} came"))
        }
        Err(other) => failed("an SDO transfer", other.to_string()),
    }
}

fn aborted(code: u32) -> String {
    match AbortCode::from_code(code) {
        Some(code) => format!("SDO abort {code}"),
        None => format!("SDO abort {code:08X}h"),
    }
}
