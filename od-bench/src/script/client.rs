//! The SDO client behind `sdo read` and `sdo write`: expedited and segmented transfers.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, DataType};
use od_runtime::{AbortCode, Frame};
use od_wire::sdo::{Request, Response};

use super::run::{Result, Runner, failed, impossible};
use super::statement::Outcome;
use od_model::values;

/// So long a client waits for an answer.
const TIMEOUT: u64 = 1_000_000;

/// How a transfer ended: with data, or with an abort.
type Transfer<T> = core::result::Result<T, u32>;

impl Runner<'_> {
    pub(super) fn read(&mut self, object: &str, outcome: &Outcome) -> Result<()> {
        let (address, data_type) = self.resolve(object)?;
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
            (_, Err(code)) => return failed(format!("{object} can be read"), aborted(code)),
        }
        self.held += 1;
        Ok(())
    }

    pub(super) fn write(
        &mut self,
        object: &str,
        value: &str,
        type_name: Option<&str>,
        outcome: &Outcome,
    ) -> Result<()> {
        let (address, own) = self.resolve(object)?;
        let data_type = match type_name {
            Some(name) => type_named(name).or_else(impossible)?,
            None => own.unwrap_or(DataType::Unsigned32),
        };
        let bytes = values::parse(data_type, value).or_else(impossible)?;
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

    /// By address, whether the device has it or not; or by name.
    fn resolve(&self, object: &str) -> Result<(Address, Option<DataType>)> {
        let dictionary = self.device().dictionary();
        match (values::find(dictionary, object), values::address(object)) {
            (Ok(entry), _) => Ok((entry.address, Some(entry.data_type))),
            (Err(_), Some(address)) => Ok((address, None)),
            (Err(why), None) => impossible(why),
        }
    }

    fn upload(&mut self, address: Address) -> Result<Transfer<Vec<u8>>> {
        match self.ask(Request::InitiateUpload { address })? {
            Response::InitiateUpload {
                size,
                expedited: Some(data),
                ..
            } => {
                let len = size.map_or(4, |size| size.min(4) as usize);
                return Ok(Ok(data[..len].to_vec()));
            }
            Response::InitiateUpload {
                expedited: None, ..
            } => {}
            Response::Abort { code, .. } => return Ok(Err(code)),
            other => return out_of_turn("an upload answer", other),
        }
        let mut bytes = Vec::new();
        let mut toggle = false;
        loop {
            match self.ask(Request::UploadSegment { toggle })? {
                Response::UploadSegment {
                    toggle: answered,
                    data,
                    len,
                    last,
                } if answered == toggle => {
                    bytes.extend_from_slice(&data[..usize::from(len)]);
                    if last {
                        return Ok(Ok(bytes));
                    }
                }
                Response::Abort { code, .. } => return Ok(Err(code)),
                other => return out_of_turn("an upload segment", other),
            }
            toggle = !toggle;
        }
    }

    fn download(&mut self, address: Address, bytes: &[u8]) -> Result<Transfer<()>> {
        let size = Some(bytes.len() as u32);
        let expedited = (1..=4).contains(&bytes.len()).then(|| {
            let mut data = [0; 4];
            data[..bytes.len()].copy_from_slice(bytes);
            data
        });
        match self.ask(Request::InitiateDownload {
            address,
            size,
            expedited,
        })? {
            Response::InitiateDownload { .. } if expedited.is_some() => return Ok(Ok(())),
            Response::InitiateDownload { .. } => {}
            Response::Abort { code, .. } => return Ok(Err(code)),
            other => return out_of_turn("a download answer", other),
        }
        let count = bytes.len().div_ceil(7).max(1);
        for number in 0..count {
            let chunk = bytes
                .get(number * 7..bytes.len().min(number * 7 + 7))
                .unwrap_or_default();
            let mut data = [0; 7];
            data[..chunk.len()].copy_from_slice(chunk);
            let toggle = number % 2 == 1;
            let segment = Request::DownloadSegment {
                toggle,
                data,
                len: chunk.len() as u8,
                last: number + 1 == count,
            };
            match self.ask(segment)? {
                Response::DownloadSegment { toggle: answered } if answered == toggle => {}
                Response::Abort { code, .. } => return Ok(Err(code)),
                other => return out_of_turn("a download segment answer", other),
            }
        }
        Ok(Ok(()))
    }

    /// Sends a request and takes its answer out of what came; the rest stays for `expect`.
    fn ask(&mut self, request: Request) -> Result<Response> {
        let node = self.device().node_id();
        let before = self.pending.len();
        self.send(&Frame::full(node.plus(0x600), request.emit()));
        let until = self.bus.now().plus_micros(TIMEOUT);
        let mut looked_at = before;
        loop {
            while let Some(sent) = self.pending.get(looked_at) {
                if sent.frame.id() == node.plus(0x580) && !sent.frame.is_remote() {
                    let answer = Response::parse(sent.frame.bytes());
                    self.pending.remove(looked_at);
                    return Ok(answer);
                }
                looked_at += 1;
            }
            if !self.bus.advance_until_sent(until) {
                return failed("an SDO answer", "none came within 1s");
            }
            self.advance(self.bus.now());
        }
    }
}

fn out_of_turn<T>(expected: &str, got: Response) -> Result<T> {
    failed(expected, format!("{got:?} came"))
}

fn aborted(code: u32) -> String {
    match AbortCode::from_code(code) {
        Some(code) => format!("SDO abort {code}"),
        None => format!("SDO abort {code:08X}h"),
    }
}

/// `u16`, `i8`, `UNSIGNED16` …
fn type_named(name: &str) -> core::result::Result<DataType, String> {
    let short = |data_type: &DataType| {
        let long = data_type.name();
        let short = long
            .replace("UNSIGNED", "u")
            .replace("INTEGER", "i")
            .replace("BOOLEAN", "bool");
        short.eq_ignore_ascii_case(name) || long.eq_ignore_ascii_case(name)
    };
    DataType::ALL
        .into_iter()
        .find(short)
        .ok_or_else(|| format!("there is no type `{name}`; write u8, u16, u32, i16 …"))
}
