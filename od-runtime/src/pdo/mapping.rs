//! Mapping of a PDO: read from its object once, and kept.

use od_model::Address;
use od_model::row::Row;
use od_model::typed::MapEntry;

use super::fixed::{Fixed, is_fixed};
use crate::application::{Application, Context};
use crate::device::{Device, ROOMY};
use crate::number::put_word;
use crate::objects::outbox::is_live;
use crate::objects::{Objects, check_mapped};
use crate::rooms::{Room, Rooms};
use crate::store::Store;
use od_wire::Instant;

/// A mapped value: in the low 24 bits one more than the position of its row, 0 for bits that nothing
/// reads, and above them its length in bits.
type Mapped = u32;

/// The mapping of one PDO.
#[derive(Clone, Debug)]
pub(super) struct Mapping<R: Rooms> {
    object: u16,
    count: u8,
    /// Length of the frame in bytes.
    len: u8,
    kept: R::Kept<Mapped>,
    /// The application brings one of the values up to date.
    is_live: bool,
    /// The same as the store has it. A microcontroller looks it up.
    plain: [Plain; ROOMY as usize],
}

/// A mapping of eight values at most, all of them numbers of up to four bytes in the store, which a master
/// may read.
#[derive(Clone, Debug)]
struct Plain {
    /// Of each value its place in the store.
    places: [u32; PLAIN],
    /// The bits that each is shorter than four bytes.
    unused: [u8; PLAIN],
    /// Addresses of the live values.
    addresses: [Address; PLAIN],
    /// Which values are live, the first one in bit 0.
    live: u8,
    /// Whether the mapping is one.
    is_one: bool,
}

/// Most values of a [`Plain`] mapping.
const PLAIN: usize = 8;

impl Plain {
    /// No plain mapping.
    const NONE: Self = Self {
        places: [0; PLAIN],
        unused: [0; PLAIN],
        addresses: [Address::new(0, 0); PLAIN],
        live: 0,
        is_one: false,
    };

    /// Adds the value at a position of the mapping.
    fn add(&mut self, store: &Store<'_>, at: usize, mapped: Mapped, live: Option<Address>) {
        let row = store
            .dictionary()
            .row((mapped as usize & 0xFF_FFFF).wrapping_sub(1));
        let slot = row.map(|row| row.plain());
        let slot = slot.filter(|slot| matches!(slot.len, 1..=4));
        let (Some(slot), Some(place), Some(unused)) =
            (slot, self.places.get_mut(at), self.unused.get_mut(at))
        else {
            self.is_one = false;
            return;
        };
        *place = slot.offset;
        *unused = 32u8.wrapping_sub((mapped >> 24) as u8);
        if let Some(address) = live
            && let Some(to) = self.addresses.get_mut(at)
        {
            *to = address;
            self.live |= 1 << at;
            // What comes from the application fills its place in the store.
            self.is_one &= mapped >> 24 == 8 * u32::from(slot.len);
        }
    }
}

impl<R: Rooms> Mapping<R> {
    /// Nothing is mapped.
    pub(super) const NONE: Self = Self {
        object: 0,
        count: 0,
        len: 0,
        kept: Room::BLANK,
        is_live: false,
        plain: [const { Plain::NONE }; ROOMY as usize],
    };

    /// Reads the mapping object at `object`. Answers whether it is another one than before. One
    /// that does not hold (an EDS that maps what is not there) is an empty one: the PDO is off.
    #[inline(never)]
    pub(super) fn load<D: Device>(&mut self, objects: &Objects<'_, D>, object: u16) -> bool {
        let store = &objects.store;
        let count = store.word(object, 0, 0).min(64) as u8;
        let mut changed = self.object != object || self.count != count;
        (self.object, self.count, self.is_live) = (object, count, false);
        for plain in &mut self.plain {
            (plain.live, plain.is_one) = (0, true);
        }
        let mut bits = 0u32;
        // 64 at most.
        for sub in 1..count + 1 {
            let raw = store.word(object, sub, 0);
            if check_mapped(store, object, raw).is_err() {
                bits = u32::MAX;
                break;
            }
            let address = MapEntry::parse(raw).address;
            let is_live = objects.is_live(address);
            self.is_live |= is_live;
            for plain in &mut self.plain {
                let at = usize::from(sub) - 1;
                plain.add(store, at, mapped(store, raw), is_live.then_some(address));
            }
            bits += raw & 0xFF;
            if let Some(kept) = self.kept.all_mut().get_mut(usize::from(sub) - 1) {
                let mapped = mapped(store, raw);
                changed |= *kept != mapped;
                *kept = mapped;
            } else {
                // What is not kept may be another value.
                changed = true;
            }
        }
        if bits > 64 {
            changed = self.len != 0;
            (self.count, bits) = (0, 0);
        }
        self.len = bits.div_ceil(8) as u8;
        changed
    }

    /// As [`load`](Self::load), where the compiler knows what the object says.
    #[inline(always)]
    pub(super) fn fix<D: Device>(
        &mut self,
        objects: &Objects<'_, D>,
        object: u16,
        fixed: &Fixed,
    ) -> bool {
        let changed = self.object != object;
        (self.object, self.len) = (object, fixed.len);
        self.count = fixed.rows().len() as u8;
        for plain in &mut self.plain {
            (plain.live, plain.is_one) = (0, true);
        }
        let mut has_live = false;
        for (at, (kept, position)) in self.kept.all_mut().iter_mut().zip(fixed.rows()).enumerate() {
            let Some(row) = objects.store.dictionary().row((*position).into()) else {
                continue;
            };
            *kept = u32::from(row.bits()) << 24 | (u32::from(*position) + 1);
            let is_live = objects.is_live(row.address());
            has_live |= is_live;
            for plain in &mut self.plain {
                plain.add(&objects.store, at, *kept, is_live.then_some(row.address()));
            }
        }
        self.is_live = has_live;
        changed
    }

    /// Length of the frame in bytes; 0 where nothing is mapped.
    #[inline(always)]
    pub(super) fn len(&self) -> u8 {
        self.len
    }

    /// Whether the application brings a mapped value up to date.
    #[inline(always)]
    pub(super) fn is_live(&self) -> bool {
        self.is_live
    }

    /// The row of a mapped value, if it has one, and its bits.
    #[inline(always)]
    fn value<'a, D: Device>(&self, store: &Store<'a>, at: u8) -> (Option<&'a Row>, u32) {
        let mapped = match self.kept.all().get(usize::from(at)) {
            Some(mapped) => *mapped,
            None if const { is_fixed::<D>() } => 0,
            // The object has not changed since `load`, so the entry is still there.
            None => mapped(store, store.word(self.object, at + 1, 0)),
        };
        let position = (mapped as usize & 0xFF_FFFF).wrapping_sub(1);
        (store.dictionary().row(position), mapped >> 24)
    }

    /// Whether all values are numbers of the store as [`gather`](Self::gather) takes them.
    #[inline(always)]
    pub(super) fn is_plain(&self) -> bool {
        self.plain.first().is_some_and(|plain| plain.is_one)
    }

    /// Puts the live values of a [plain](Self::is_plain) mapping into the store, as the application has them at
    /// hand. `None` if it does not have all of them.
    #[inline(always)]
    pub(super) fn fetch_live(
        &self,
        application: &mut dyn Application,
        values: &mut [u8],
        now: Instant,
    ) -> Option<()> {
        let plain = self.plain.first()?;
        let mut live = plain.live;
        while live != 0 {
            let at = live.trailing_zeros() as usize % PLAIN;
            live &= live - 1;
            let number = application.number(now, *plain.addresses.get(at)?)?;
            let (place, unused) = (plain.places.get(at)?, *plain.unused.get(at)?);
            put_word(values, *place as usize, unused.into(), number)?;
        }
        Some(())
    }

    /// Has the application bring the live values up to date, by the set of them.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn refresh<D: Device>(
        &self,
        application: &mut dyn Application,
        context: &mut Context<'_, '_>,
        live: u32,
    ) {
        for at in 0..self.count {
            if let (Some(row), _) = self.value::<D>(context.store, at) {
                let address = row.address();
                if is_live(live, address) {
                    // A PDO has no way to say that a value could not be had; it takes the last one.
                    let _ = application.refresh(context, address);
                }
            }
        }
    }

    /// As [`gather`](Self::gather), of a mapping with one value; `None` if it has more.
    #[inline(always)]
    pub(super) fn single(&self, values: &[u8]) -> Option<u64> {
        let ([place, ..], [unused, ..]) = self.plain.first().map(|it| (&it.places, it.unused))?;
        let word = cut_word(values, *place, unused);
        word.filter(|_| self.count == 1).map(u64::from)
    }

    /// Returns the frame's bytes with the values of the store, as a number. The mapping is to be
    /// [plain](Self::is_plain); `None` if a value is one of the last of the store.
    #[inline(always)]
    pub(super) fn gather(&self, values: &[u8]) -> Option<u64> {
        let plain = self.plain.first()?;
        let (mut data, mut first) = (0u64, 0);
        let places = plain.places.get(..self.count.into())?;
        for (place, unused) in places.iter().zip(plain.unused) {
            data |= u64::from(cut_word(values, *place, unused)?) << (first & 63);
            first += 32 - u32::from(unused);
        }
        Some(data)
    }

    /// Returns the frame's bytes with the values of the store.
    #[inline(never)]
    pub(super) fn read<D: Device>(&self, store: &Store<'_>) -> [u8; 8] {
        let (mut data, mut first) = (0u64, 0);
        for at in 0..self.count {
            let (row, bits) = self.value::<D>(store, at);
            if let Some(row) = row {
                data |= cut(store.number_of(row), bits) << (first & 63);
            }
            first += bits;
        }
        data.to_le_bytes()
    }

    /// Returns the frame's bytes with the current values, live ones updated.
    pub(super) fn sample<D: Device>(&self, objects: &mut Objects<'_, D>) -> [u8; 8] {
        if self.is_live {
            let live = objects.outbox.live;
            objects
                .application(|application, context| self.refresh::<D>(application, context, live));
        }
        self.read::<D>(&objects.store)
    }

    /// Writes the frame's bytes into the objects, each by the rules of its own; one that
    /// refuses its value keeps the old one.
    #[inline(never)]
    pub(super) fn apply<D: Device>(&self, objects: &mut Objects<'_, D>, data: [u8; 8]) {
        let mut data = u64::from_le_bytes(data);
        for at in 0..self.count {
            let (row, bits) = self.value::<D>(&objects.store, at);
            if let Some(row) = row {
                let value = cut(data, bits).to_le_bytes();
                let value = value.get(..row.size()).unwrap_or_default();
                let _ = objects.write(row.address(), value);
                let _ = objects.carry_out();
            }
            data = data.checked_shr(bits).unwrap_or(0);
        }
    }
}

/// A number of the store that is some bits shorter than four bytes.
#[inline(always)]
fn cut_word(values: &[u8], place: u32, unused: u8) -> Option<u32> {
    let at = place as usize;
    let word = u32::from_le_bytes(*values.get(at..at + 4)?.first_chunk()?);
    Some(word.wrapping_shl(unused.into()).wrapping_shr(unused.into()))
}

/// Decodes an entry of a mapping object.
fn mapped(store: &Store<'_>, raw: u32) -> Mapped {
    let MapEntry { address, bits } = MapEntry::parse(raw);
    let row = match store.dictionary().locate(address) {
        Some((at, _)) => at as u32 + 1,
        None => 0,
    };
    u32::from(bits) << 24 | row & 0xFF_FFFF
}

/// Cuts a value to its mapped bits; only a BOOLEAN does not fill whole bytes.
#[inline(always)]
const fn cut(value: u64, bits: u32) -> u64 {
    match bits {
        1 => value & 1,
        _ => value,
    }
}
