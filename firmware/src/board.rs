//! Start-up, the clock of the processor, and calls of the emulator.

use core::arch::{asm, global_asm};
use core::cell::UnsafeCell;
use core::ffi::CStr;
use core::panic::PanicInfo;
use core::sync::atomic::{AtomicBool, Ordering};

/// Content of RAM that the program has not written yet.
const PAINT: u32 = 0xA5A5_A5A5;

// Fills the RAM with the pattern; then .data gets its content and .bss its zeros.
global_asm!(
    ".syntax unified",
    ".section .text.reset",
    ".global reset",
    ".thumb_func",
    "reset:",
    "ldr r0, =__data_start",
    "ldr r1, =__stack_top",
    "ldr r2, ={paint}",
    "1: str r2, [r0]",
    "adds r0, #4",
    "cmp r0, r1",
    "bcc 1b",
    "ldr r0, =__data_start",
    "ldr r1, =__data_end",
    "ldr r2, =__data_load",
    "2: cmp r0, r1",
    "bcs 3f",
    "ldr r3, [r2]",
    "str r3, [r0]",
    "adds r0, #4",
    "adds r2, #4",
    "b 2b",
    "3: ldr r0, =__bss_start",
    "ldr r1, =__bss_end",
    "movs r2, #0",
    "4: cmp r0, r1",
    "bcs 5f",
    "str r2, [r0]",
    "adds r0, #4",
    "b 4b",
    "5: bl main",
    "b .",
    ".pool",
    paint = const PAINT,
);

unsafe extern "C" {
    static __data_start: u32;
    static __bss_end: u32;
    static __stack_top: u32;
    static __flash_end: u32;
    static mut __eeprom: [u8; 16 * 1024];
}

/// A static value that the program takes once and then owns.
pub struct Once<T>(UnsafeCell<T>, AtomicBool);

// SAFETY: `take` hands the value out once, to its first caller.
unsafe impl<T> Sync for Once<T> {}

impl<T> Once<T> {
    /// A value that was not taken yet.
    pub const fn new(value: T) -> Self {
        Self(UnsafeCell::new(value), AtomicBool::new(false))
    }

    /// Takes the value.
    #[allow(clippy::mut_from_ref)] // once
    pub fn take(&self) -> &mut T {
        take(&self.1);
        // SAFETY: this is the first call, and interrupts do not exist.
        unsafe { &mut *self.0.get() }
    }
}

/// `N` bytes outside the RAM of the program, as an EEPROM. The value itself is all zeros, so a
/// static node that contains it takes no flash.
pub struct Eeprom<const N: usize>(());

impl<const N: usize> Eeprom<N> {
    /// The EEPROM.
    ///
    /// # Safety
    /// A program has one, and no other memory in the section `.eeprom`.
    pub const unsafe fn new() -> Self {
        const { assert!(N <= 16 * 1024) };
        Self(())
    }
}

impl<const N: usize> AsRef<[u8]> for Eeprom<N> {
    fn as_ref(&self) -> &[u8] {
        // SAFETY: `self` owns the bytes, and the linker keeps `N` of them free.
        unsafe { core::slice::from_raw_parts((&raw const __eeprom).cast(), N) }
    }
}

impl<const N: usize> AsMut<[u8]> for Eeprom<N> {
    fn as_mut(&mut self) -> &mut [u8] {
        // SAFETY: as above.
        unsafe { core::slice::from_raw_parts_mut((&raw mut __eeprom).cast(), N) }
    }
}

/// Marks something as taken; the second call for it ends the program.
#[inline(never)]
fn take(taken: &AtomicBool) {
    if taken.load(Ordering::Relaxed) {
        exit(false);
    }
    taken.store(true, Ordering::Relaxed);
}

/// Bytes of flash (code, constants, content of .data), and bytes of static RAM.
pub fn sizes() -> (u32, u32) {
    let of = |symbol: *const u32| symbol as u32;
    let ram = of(&raw const __bss_end) - of(&raw const __data_start);
    (of(&raw const __flash_end), ram)
}

/// Maximum size of the stack so far, in bytes.
#[inline(never)]
pub fn stack() -> u32 {
    let top = &raw const __stack_top;
    let mut at = &raw const __bss_end;
    // SAFETY: from the end of .bss to the top of the stack all is RAM.
    while at < top && unsafe { at.read_volatile() } == PAINT {
        at = at.wrapping_add(1);
    }
    top as u32 - at as u32
}

const SYSTICK: *mut u32 = 0xE000_E010 as *mut u32;

/// Starts the clock that counts instructions: with `-icount shift=10` the processor takes 1024 ns
/// for each, and the clock has a tick every 80 ns.
pub fn start_clock() {
    // SAFETY: the registers of SysTick, which nothing else uses.
    unsafe {
        SYSTICK.add(1).write_volatile(0xFF_FFFF);
        SYSTICK.add(2).write_volatile(0);
        SYSTICK.write_volatile(5);
    }
}

/// Ticks of the clock, counted downwards modulo 2²⁴.
#[inline(always)]
pub fn clock() -> u32 {
    // SAFETY: a register without side effects.
    unsafe { SYSTICK.add(2).read_volatile() }
}

fn semihosting(operation: u32, parameter: usize) -> usize {
    let answer;
    // SAFETY: the emulator reads what `parameter` points to, and r0 is its answer.
    unsafe {
        asm!("bkpt 0xAB", inout("r0") operation as usize => answer, in("r1") parameter, options(nostack));
    }
    answer
}

/// A file of the computer that runs the emulator.
pub struct File(usize);

impl File {
    /// Opens a file to read, or creates one to write.
    pub fn open(name: &CStr, writes: bool) -> Self {
        let mode = if writes { 5 } else { 1 };
        let block = [name.as_ptr() as usize, mode, name.to_bytes().len()];
        Self(semihosting(0x01, block.as_ptr() as usize))
    }

    /// Reads until `to` is full or the file ends; returns the number of bytes.
    pub fn read(&self, to: &mut [u8]) -> usize {
        let block = [self.0, to.as_mut_ptr() as usize, to.len()];
        let missing = semihosting(0x06, block.as_ptr() as usize);
        to.len().saturating_sub(missing)
    }

    /// Writes bytes.
    pub fn write(&self, bytes: &[u8]) {
        let block = [self.0, bytes.as_ptr() as usize, bytes.len()];
        semihosting(0x05, block.as_ptr() as usize);
    }
}

/// Prints `name` and a number in hex on a line. `name` ends with a 0.
pub fn print(name: &[u8], number: u32) {
    let mut line = *b" 00000000\n\0";
    for (at, digit) in line[1..9].iter_mut().enumerate() {
        let nibble = (number >> (28 - 4 * at) & 15) as u8;
        *digit = nibble + if nibble < 10 { b'0' } else { b'a' - 10 };
    }
    semihosting(4, name.as_ptr() as usize);
    semihosting(4, line.as_ptr() as usize);
}

/// Ends the program.
pub fn exit(well: bool) -> ! {
    semihosting(0x18, if well { 0x2_0026 } else { 0x2_0023 });
    loop {
        core::hint::spin_loop();
    }
}

#[cfg(feature = "may-panic")]
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    exit(false)
}

/// A program with a path that leads here does not link.
#[cfg(not(feature = "may-panic"))]
#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        safe fn a_panic_can_be_reached() -> !;
    }
    a_panic_can_be_reached()
}
