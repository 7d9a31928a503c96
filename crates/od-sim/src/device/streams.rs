//! Values of any length of a device of a file, as streams of SDO transfers: strings, DOMAINs, programs.

use std::prelude::v1::*;

use od_model::Address;
use od_runtime::{AbortCode, Application, Chunk, Context, Halt, Store, Stream, StreamEnd};

use crate::device::application::DeviceApplication;
use crate::device::file_parts::{Long, room};
use crate::device::programs::Loader;

/// Strings, DOMAINs and programs of a device of a file.
impl DeviceApplication {
    fn long(&mut self) -> &mut Long {
        &mut self.file_parts.get_or_insert_default().long
    }

    /// The program that belongs to an object; otherwise the strings and DOMAINs.
    pub(crate) fn file_stream(&mut self, address: Address) -> &mut dyn Stream {
        let programs = &mut self.file_parts.get_or_insert_default().programs;
        let loads = |loader: &mut Loader| loader.stream(address).is_some();
        match programs.iter_mut().position(loads) {
            Some(at) => &mut self.file_parts.get_or_insert_default().programs[at],
            None => self,
        }
    }

    /// Calls `look` with the bytes at an address.
    fn look<R>(
        &mut self,
        store: &Store<'_>,
        address: Address,
        look: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, Halt> {
        if let Some(value) = self.long().get(address) {
            return Ok(look(value));
        }
        let entry = store.dictionary().find(address).map_err(AbortCode::from)?;
        Ok(look(store.bytes(&entry, &mut [0; 8])))
    }

    /// Greatest length of the value at an address, in bytes.
    fn limit(&mut self, store: &Store<'_>, address: Address) -> Result<usize, Halt> {
        let entry = store.dictionary().find(address).map_err(AbortCode::from)?;
        Ok(self.long().limit(store, &entry))
    }

    /// Stores a value whose last part was written.
    fn keep(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), Halt> {
        let mut value = core::mem::take(self.long().coming(address));
        value.shrink_to_fit();
        self.behaviour_mut().validate(cx, address, &value)?;
        let entry = cx
            .store
            .dictionary()
            .find(address)
            .map_err(AbortCode::from)?;
        self.long().remove(address);
        if value.len() <= room(&entry) {
            cx.store.put(&entry, &value)?;
        } else {
            // The store has no room for it, and holds the default, which is what 1010h saves.
            cx.store.reset_entry(&entry);
            self.long().values.push((address, value));
        }
        self.behaviour_mut().written(cx, address);
        Ok(())
    }
}

/// Strings and DOMAINs of a device of a file.
impl Stream for DeviceApplication {
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        size: Option<u32>,
    ) -> Result<(), Halt> {
        let limit = self.limit(cx.store, address)?;
        if size.is_some_and(|size| size as usize > limit) {
            return Err(AbortCode::TooLong.into());
        }
        Ok(())
    }

    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt> {
        let limit = self.limit(cx.store, address)?;
        if self.long().coming(address).len() + chunk.bytes.len() > limit {
            return Err(AbortCode::TooLong.into());
        }
        self.long().coming(address).extend_from_slice(chunk.bytes);
        if chunk.last {
            self.keep(cx, address)
        } else {
            Ok(())
        }
    }

    fn begin_upload(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<u32, Halt> {
        if address.index >= 0x2000 {
            self.behaviour_mut().refresh(cx, address)?;
        }
        let len = self.look(cx.store, address, <[u8]>::len)?;
        Ok(u32::try_from(len).map_err(|_| AbortCode::OutOfMemory)?)
    }

    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        let at = at as usize;
        self.look(cx.store, address, |value| {
            // The value may have changed since the server announced its length.
            let part = value.get(at..at + to.len()).ok_or(AbortCode::General)?;
            to.copy_from_slice(part);
            Ok(())
        })?
    }

    fn end(&mut self, _: &mut Context<'_, '_>, address: Address, _: StreamEnd) {
        self.long().coming.retain(|(own, _)| *own != address);
    }
}
