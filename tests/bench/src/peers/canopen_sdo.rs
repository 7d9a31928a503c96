//! canopen-sdo with a hand-written `match`: an SDO server alone.

use ::canopen_sdo::{ObjectDictionary, SdoAbortCode, SdoFrame, SdoServer, ServerConfig};

use crate::contender::Upload;
use crate::objects;

include!(concat!(env!("OUT_DIR"), "/match.rs"));

/// `N` values, in the order of their addresses.
#[derive(Debug)]
pub struct Values<const N: usize>([u32; N]);

/// The value at an address.
#[derive(Debug)]
pub enum Place<'a> {
    /// A U32.
    Value(&'a mut u32),
    /// Sub-index 0 of a record.
    Count(u8),
}

/// The `match` itself, one per size, in `match.rs`.
pub trait Find {
    /// Finds the value at an address.
    fn find(&mut self, index: u16, sub: u8) -> Option<Place<'_>>;
}

impl<const N: usize> ObjectDictionary for Values<N>
where
    Self: Find,
{
    #[inline]
    fn read(&mut self, index: u16, sub: u8, buf: &mut [u8]) -> Result<usize, SdoAbortCode> {
        match self.find(index, sub) {
            Some(Place::Value(value)) => {
                buf[..4].copy_from_slice(&value.to_le_bytes());
                Ok(4)
            }
            Some(Place::Count(count)) => {
                buf[0] = count;
                Ok(1)
            }
            None => Err(SdoAbortCode::ObjectDoesNotExist),
        }
    }

    fn write(&mut self, index: u16, sub: u8, data: &[u8]) -> Result<(), SdoAbortCode> {
        let value = match self.find(index, sub) {
            Some(Place::Value(value)) => value,
            Some(Place::Count(_)) => return Err(SdoAbortCode::WriteReadOnly),
            None => return Err(SdoAbortCode::ObjectDoesNotExist),
        };
        let data = data
            .try_into()
            .map_err(|_| SdoAbortCode::DataTypeLengthMismatch)?;
        *value = u32::from_le_bytes(data);
        Ok(())
    }
}

/// The server with its values.
/// Its transfer buffer has eight bytes, enough for every object here: the
/// server clears it for every request, so more would only make it slower.
/// server clears it for every request, so more would only slow it down.
#[allow(missing_debug_implementations)] // canopen-sdo's server has none
pub struct CanopenSdo<const N: usize> {
    server: SdoServer<8>,
    values: Values<N>,
}

impl<const N: usize> CanopenSdo<N> {
    /// A server for `size` objects, which have `N` values.
    pub fn new(size: usize) -> Self {
        let mut values = [0; N];
        for (value, (index, sub)) in values.iter_mut().zip(objects::addresses(size)) {
            *value = objects::value(index, sub);
        }
        Self {
            server: SdoServer::new(ServerConfig::new(objects::NODE_ID)),
            values: Values(values),
        }
    }
}

impl<const N: usize> Upload for CanopenSdo<N>
where
    Values<N>: Find,
{
    #[inline]
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        let frame = SdoFrame::new(SdoFrame::rsdo_id(objects::NODE_ID), *request);
        let taken = self.server.handle_frame(frame, 0, &mut self.values);
        assert!(taken.is_ok(), "the object exists");
        self.server.poll_transmit().expect("an answer").data
    }
}
