//! Compares the functions of `od-thumb` with loops: lengths, alignments and overlaps of copies, and quotients.
#![no_std]
#![no_main]

use core::hint::black_box;

use odkit_firmware::board;

unsafe extern "C" {
    fn memcpy(to: *mut u8, from: *const u8, len: usize) -> *mut u8;
    fn memmove(to: *mut u8, from: *const u8, len: usize) -> *mut u8;
    fn memset(to: *mut u8, byte: i32, len: usize) -> *mut u8;
    fn memcmp(one: *const u8, other: *const u8, len: usize) -> i32;
}

const SIZE: usize = 40;
type Bytes = [u8; SIZE];

/// Byte `at` of a pattern.
const fn pattern(at: usize) -> u8 {
    (at as u8).wrapping_mul(37).wrapping_add(11)
}

fn patterns() -> Bytes {
    core::array::from_fn(pattern)
}

/// Returns whether a function changes the bytes of a pattern as `expected` says, and returns its destination.
fn changes(act: impl Fn(*mut u8) -> (*mut u8, *mut u8), expected: impl Fn(usize) -> u8) -> bool {
    let mut bytes = patterns();
    let (returned, to) = act(bytes.as_mut_ptr());
    let all = bytes.iter().enumerate();
    returned == to && all.fold(true, |well, (at, byte)| well & (*byte == expected(at)))
}

/// Moves and fills of every length at every alignment.
fn moves() -> bool {
    let mut well = true;
    for (to, from) in (0..12).flat_map(|to| (0..12).map(move |from| (to, from))) {
        for len in 0..SIZE - 12 {
            let moved = |at: usize| match at.checked_sub(to) {
                Some(offset) if offset < len => pattern(from + offset),
                _ => pattern(at),
            };
            // SAFETY: both ranges are inside of the bytes.
            let act = |bytes: *mut u8| unsafe {
                let to = bytes.add(to);
                (memmove(to, bytes.add(from), len), to)
            };
            well &= changes(act, moved);
            let filled = |at: usize| match at.checked_sub(to) {
                Some(offset) if offset < len => from as u8,
                _ => pattern(at),
            };
            // SAFETY: the range is inside of the bytes.
            let act = |bytes: *mut u8| unsafe {
                let to = bytes.add(to);
                (memset(to, 0x100 | from as i32, len), to)
            };
            well &= changes(act, filled);
            let source = patterns();
            // SAFETY: the ranges are inside of two arrays.
            let act = |bytes: *mut u8| unsafe {
                let to = bytes.add(to);
                (memcpy(to, source.as_ptr().add(from), len), to)
            };
            well &= changes(act, moved);
        }
    }
    well
}

/// Comparisons with a difference at each place, and without one.
fn comparisons() -> bool {
    let mut well = true;
    let one = patterns();
    for (len, place) in (0..SIZE).flat_map(|len| (0..SIZE).map(move |place| (len, place))) {
        let mut other = one;
        if let Some(byte) = other.get_mut(place) {
            *byte ^= 0x80;
        }
        let is_less = pattern(place) < 0x80;
        // SAFETY: both have `SIZE` bytes.
        let result = unsafe { memcmp(one.as_ptr(), other.as_ptr(), len) };
        well &= match result {
            0 => place >= len,
            less => place < len && (less < 0) == is_less,
        };
    }
    well
}

/// Divisions of numbers near powers of two: quotient and remainder give the dividend again.
fn divisions() -> bool {
    let mut well = true;
    let numbers = |bit: u32| [(1u64 << bit) - 1, 1 << bit, (1 << bit) + 1, (3 << bit) | 5];
    let all = || (0..63).flat_map(numbers);
    for (n, d) in all().flat_map(|n| all().map(move |d| (n, d))) {
        let Some(quotient) = black_box(n).checked_div(black_box(d)) else {
            continue;
        };
        let rest = n.wrapping_sub(quotient.wrapping_mul(d));
        well &= rest < d && black_box(n).checked_rem(d) == Some(rest);
        let (n, d) = ((n as i64).wrapping_neg(), d as i64);
        let (Some(quotient), Some(rest)) = (
            black_box(n).checked_div(black_box(d)),
            black_box(n).checked_rem(black_box(d)),
        ) else {
            continue;
        };
        well &= quotient.wrapping_mul(d).wrapping_add(rest) == n;
        well &= rest.unsigned_abs() < d.unsigned_abs() && (rest == 0 || (rest < 0) == (n < 0));
    }
    well
}

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    let results = [moves(), comparisons(), divisions()];
    let well = results.iter().all(|well| *well);
    if well {
        board::print(b"the program runs\n\0", 0);
    } else {
        for well in results {
            board::print(b"well\0", well.into());
        }
    }
    board::exit(well)
}
