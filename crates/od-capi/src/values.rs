//! Values and errors that the firmware sets, in a callback or outside.
#![allow(unsafe_code)]

use core::ffi::c_void;
use core::slice;

use odkit::{AbortCode, Address, Device, Emcy, Entry, Store, nmt};

use crate::answer::{ODKIT_ARGUMENT, ODKIT_NULL, ODKIT_OK, ODKIT_SIZE};
use crate::instance::{Instance, answer, put};
use crate::number::{self, ValueBytes};

fn find(store: &Store<'_>, address: Address) -> Result<Entry, u32> {
    let found = store.dictionary().find(address);
    found.map_err(|missing| AbortCode::from(missing).code())
}

impl<D: Device> Instance<D> {
    /// Reads values, in a callback or outside.
    fn look<R>(&self, read: impl Fn(&Store<'_>) -> Result<R, u32>) -> Result<R, u32> {
        if let Some(result) = self.nested.with(|cx| read(cx.store)) {
            return result;
        }
        self.open(|node, _| node.look(|_, store| read(store)))
    }

    /// Writes a value, in a callback or outside.
    fn write(&self, now_us: u32, address: Address, bytes: &[u8]) -> Result<(), u32> {
        let nested = self.nested.with(|cx| {
            let entry = find(cx.store, address)?;
            cx.store.put(&entry, bytes).map_err(AbortCode::code)?;
            if (0x1000..0x2000).contains(&address.index) {
                cx.signals.reconfigure();
            }
            Ok(())
        });
        if let Some(result) = nested {
            return result;
        }
        self.open(|node, clock| {
            node.application.own = true;
            let set = node.set_value(clock.at(now_us), address, bytes);
            node.application.own = false;
            set.map_err(AbortCode::code)
        })
    }

    /// See `odkit_get`.
    ///
    /// # Safety
    /// `to` is null or points to room for `size` bytes; `len` is null or points to a size.
    pub unsafe fn get(
        &self,
        index: u16,
        sub: u8,
        to: *mut c_void,
        size: usize,
        len: *mut usize,
    ) -> u32 {
        if to.is_null() && size != 0 {
            return ODKIT_NULL;
        }
        answer(self.look(|store| {
            let entry = find(store, Address::new(index, sub))?;
            let mut number = [0; 8];
            let bytes = store.bytes(&entry, &mut number);
            if !len.is_null() {
                // SAFETY: it is not null, and the caller's.
                unsafe { put(len, bytes.len()) };
            }
            if bytes.len() > size {
                return Err(ODKIT_SIZE);
            }
            let to = to.cast::<u8>();
            // SAFETY: there is room for `size` bytes, if `size` is not 0; the values are not in the
            // caller's memory.
            unsafe { to.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
            Ok(())
        }))
    }

    /// See `odkit_get_u32`.
    ///
    /// # Safety
    /// `to` is null or points to a number.
    pub unsafe fn get_u32(&self, index: u16, sub: u8, to: *mut u32) -> u32 {
        // SAFETY: the caller's.
        unsafe {
            self.get_number(index, sub, to, |store, entry| {
                number::unsigned(store, entry, 32).map(|value| value as u32)
            })
        }
    }

    /// See `odkit_get_i32`.
    ///
    /// # Safety
    /// `to` is null or points to a number.
    pub unsafe fn get_i32(&self, index: u16, sub: u8, to: *mut i32) -> u32 {
        // SAFETY: the caller's.
        unsafe {
            self.get_number(index, sub, to, |store, entry| {
                number::signed(store, entry, 32).map(|value| value as i32)
            })
        }
    }

    /// See `odkit_get_u64`.
    ///
    /// # Safety
    /// `to` is null or points to a number.
    pub unsafe fn get_u64(&self, index: u16, sub: u8, to: *mut u64) -> u32 {
        // SAFETY: the caller's.
        unsafe {
            self.get_number(index, sub, to, |store, entry| {
                number::unsigned(store, entry, 64)
            })
        }
    }

    /// See `odkit_get_i64`.
    ///
    /// # Safety
    /// `to` is null or points to a number.
    pub unsafe fn get_i64(&self, index: u16, sub: u8, to: *mut i64) -> u32 {
        // SAFETY: the caller's.
        unsafe {
            self.get_number(index, sub, to, |store, entry| {
                number::signed(store, entry, 64)
            })
        }
    }

    /// See `odkit_get_f32`.
    ///
    /// # Safety
    /// `to` is null or points to a number.
    pub unsafe fn get_f32(&self, index: u16, sub: u8, to: *mut f32) -> u32 {
        // SAFETY: the caller's.
        unsafe { self.get_number(index, sub, to, number::single) }
    }

    /// # Safety
    /// `to` is null or points to a number.
    unsafe fn get_number<T>(
        &self,
        index: u16,
        sub: u8,
        to: *mut T,
        read: impl Fn(&Store<'_>, &Entry) -> Result<T, u32>,
    ) -> u32 {
        if to.is_null() {
            return ODKIT_NULL;
        }
        let address = Address::new(index, sub);
        answer(self.look(|store| {
            let value = read(store, &find(store, address)?)?;
            // SAFETY: it is not null, and the caller's.
            unsafe { put(to, value) };
            Ok(())
        }))
    }

    /// See `odkit_set`.
    ///
    /// # Safety
    /// `from` is null or points to `len` bytes.
    pub unsafe fn set(
        &self,
        now_us: u32,
        index: u16,
        sub: u8,
        from: *const c_void,
        len: usize,
    ) -> u32 {
        if from.is_null() && len != 0 {
            return ODKIT_NULL;
        }
        // No value is longer, and a slice may not have the greatest `usize` as length.
        if len > usize::from(u16::MAX) {
            return ODKIT_ARGUMENT;
        }
        let bytes = match len {
            0 => &[],
            // SAFETY: it is not null, and the caller's.
            _ => unsafe { slice::from_raw_parts(from.cast::<u8>(), len) },
        };
        answer(self.write(now_us, Address::new(index, sub), bytes))
    }

    /// See `odkit_set_u32`.
    pub fn set_u32(&self, now_us: u32, index: u16, sub: u8, value: u32) -> u32 {
        let bytes = |entry: &Entry| number::from_unsigned(entry.data_type, value.into(), 32);
        self.set_number(now_us, Address::new(index, sub), bytes)
    }

    /// See `odkit_set_i32`.
    pub fn set_i32(&self, now_us: u32, index: u16, sub: u8, value: i32) -> u32 {
        let bytes = |entry: &Entry| number::from_signed(entry.data_type, value.into(), 32);
        self.set_number(now_us, Address::new(index, sub), bytes)
    }

    /// See `odkit_set_u64`.
    pub fn set_u64(&self, now_us: u32, index: u16, sub: u8, value: u64) -> u32 {
        let bytes = |entry: &Entry| number::from_unsigned(entry.data_type, value, 64);
        self.set_number(now_us, Address::new(index, sub), bytes)
    }

    /// See `odkit_set_i64`.
    pub fn set_i64(&self, now_us: u32, index: u16, sub: u8, value: i64) -> u32 {
        let bytes = |entry: &Entry| number::from_signed(entry.data_type, value, 64);
        self.set_number(now_us, Address::new(index, sub), bytes)
    }

    /// See `odkit_set_f32`.
    pub fn set_f32(&self, now_us: u32, index: u16, sub: u8, value: f32) -> u32 {
        let bytes = |entry: &Entry| number::from_single(entry.data_type, value);
        self.set_number(now_us, Address::new(index, sub), bytes)
    }

    fn set_number(
        &self,
        now_us: u32,
        address: Address,
        bytes: impl Fn(&Entry) -> Result<ValueBytes, u32>,
    ) -> u32 {
        let value = self.look(|store| bytes(&find(store, address)?));
        answer(value.and_then(|(bytes, len)| {
            let bytes = bytes.get(..len).unwrap_or(&bytes);
            self.write(now_us, address, bytes)
        }))
    }

    /// See `odkit_raise`.
    ///
    /// # Safety
    /// `info` is null or points to five bytes.
    pub unsafe fn raise(&self, now_us: u32, code: u16, register: u8, info: *const u8) -> u32 {
        // SAFETY: the caller's.
        let error = unsafe { emcy(code, register, info) };
        self.error(now_us, error, true)
    }

    /// See `odkit_clear`.
    ///
    /// # Safety
    /// `info` is null or points to five bytes.
    pub unsafe fn clear(&self, now_us: u32, code: u16, register: u8, info: *const u8) -> u32 {
        // SAFETY: the caller's.
        let error = unsafe { emcy(code, register, info) };
        self.error(now_us, error, false)
    }

    fn error(&self, now_us: u32, error: Emcy, comes: bool) -> u32 {
        // 0000h means error reset, not an error.
        if error.code == 0 {
            return ODKIT_ARGUMENT;
        }
        let Emcy {
            code,
            register,
            info,
        } = error;
        let nested = self.nested.with(|cx| {
            if comes {
                cx.signals.raise(error)
            } else {
                cx.signals.clear_one(code, register, info)
            }
        });
        if nested.is_some() {
            return ODKIT_OK;
        }
        answer(self.open(|node, clock| {
            if node.state() == nmt::State::Initialising {
                return Err(AbortCode::DeviceState.code());
            }
            let now = clock.at(now_us);
            // An error that is active already, or that is not active, needs no message.
            let _ = if comes {
                node.raise(now, error)
            } else {
                node.clear(now, error)
            };
            Ok(())
        }))
    }
}

/// # Safety
/// `info` is null or points to five bytes.
unsafe fn emcy(code: u16, register: u8, info: *const u8) -> Emcy {
    let info = if info.is_null() {
        [0; 5]
    } else {
        // SAFETY: the caller's.
        unsafe { info.cast::<[u8; 5]>().read() }
    };
    Emcy {
        code,
        register,
        info,
    }
}
