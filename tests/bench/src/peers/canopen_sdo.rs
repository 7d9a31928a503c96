//! canopen-sdo over a hand-written `match`: an SDO server and nothing around it.

use ::canopen_sdo::{ObjectDictionary, SdoAbortCode, SdoFrame, SdoServer, ServerConfig};

use crate::contender::Upload;
use crate::objects;

include!(concat!(env!("OUT_DIR"), "/match.rs"));

/// The values of `N` objects, in the order of their indices.
#[derive(Debug)]
pub struct Values<const N: usize>([u32; N]);

/// The `match` itself, one per size, in `match.rs`.
pub trait Find {
    /// The place of the value at an address.
    fn find(&mut self, index: u16, sub: u8) -> Option<&mut u32>;
}

impl<const N: usize> ObjectDictionary for Values<N>
where
    Self: Find,
{
    #[inline]
    fn read(&mut self, index: u16, sub: u8, buf: &mut [u8]) -> Result<usize, SdoAbortCode> {
        let value = self
            .find(index, sub)
            .ok_or(SdoAbortCode::ObjectDoesNotExist)?;
        buf[..4].copy_from_slice(&value.to_le_bytes());
        Ok(4)
    }

    fn write(&mut self, index: u16, sub: u8, data: &[u8]) -> Result<(), SdoAbortCode> {
        let value = self
            .find(index, sub)
            .ok_or(SdoAbortCode::ObjectDoesNotExist)?;
        let data = data
            .try_into()
            .map_err(|_| SdoAbortCode::DataTypeLengthMismatch)?;
        *value = u32::from_le_bytes(data);
        Ok(())
    }
}

/// The server with its values.
///
/// Its transfer buffer holds eight bytes, enough for every object here: the
/// server clears it for every request, so more would only slow it down.
#[allow(missing_debug_implementations)] // canopen-sdo's server has none
pub struct CanopenSdo<const N: usize> {
    server: SdoServer<8>,
    values: Values<N>,
}

impl<const N: usize> CanopenSdo<N> {
    /// A server for `N` objects.
    pub fn new() -> Self {
        let mut values = [0; N];
        for (value, index) in values.iter_mut().zip(objects::indices(N)) {
            *value = objects::value(index);
        }
        Self {
            server: SdoServer::new(ServerConfig::new(objects::NODE_ID)),
            values: Values(values),
        }
    }
}

impl<const N: usize> Default for CanopenSdo<N> {
    fn default() -> Self {
        Self::new()
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
