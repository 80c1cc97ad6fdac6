//! The verilated designs, through their C interface.
//!
//! In this crate `unsafe` is allowed only here: a design is a C++ object, and only C can be called from Rust. Why it is sound:
//! a [`Design`] owns its object from `create` to `destroy`, hands out no pointer, and every call goes through `&mut self`. The
//! structures are `repr(C)` and consist of integers and `bool`, field for field like those in `shim/`, whose `bool` is one byte
//! of 0 or 1, as Rust's is.
#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_void};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

#[cfg(feature = "library")]
use crate::library::{FaultyBoard, LibraryError};

/// The inputs of `halfrow_bridge` that a simulated board uses.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BridgeInputs {
    pub(crate) rst: bool,
    pub(crate) rx_valid: bool,
    pub(crate) rx_data: u8,
    pub(crate) tx_ready: bool,
    pub(crate) millisecond: bool,
}

/// Its outputs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BridgeOutputs {
    pub(crate) rx_ready: bool,
    pub(crate) tx_valid: bool,
    pub(crate) tx_data: u8,
    pub(crate) quiet: bool,
}

/// The inputs of `halfrow_uart_bridge`, and which of its clocks rise.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct UartInputs {
    pub(crate) link_edge: bool,
    pub(crate) core_edge: bool,
    pub(crate) rst: bool,
    pub(crate) rxd: bool,
    pub(crate) cts_n: bool,
    pub(crate) millisecond: bool,
}

/// Its outputs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct UartOutputs {
    pub(crate) txd: bool,
    pub(crate) rts_n: bool,
    pub(crate) quiet: bool,
}

/// The inputs of `halfrow_fifo_bridge`, and which of its clocks rise.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FifoInputs {
    pub(crate) link_edge: bool,
    pub(crate) core_edge: bool,
    pub(crate) rst: bool,
    pub(crate) rxf_n: bool,
    pub(crate) txe_n: bool,
    pub(crate) data: u8,
    pub(crate) millisecond: bool,
}

/// Its outputs.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FifoOutputs {
    pub(crate) rd_n: bool,
    pub(crate) wr_n: bool,
    pub(crate) siwu_n: bool,
    /// Whether WR# and SIWU# are driven.
    pub(crate) control_drive: bool,
    pub(crate) data: u8,
    pub(crate) data_drive: bool,
    pub(crate) quiet: bool,
}

/// The inputs of `halfrow_core`.
#[cfg(feature = "builds")]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
#[expect(
    missing_docs,
    reason = "the ports of that name in fpga/rtl/core/halfrow_core.v, without those of read-back"
)]
pub struct CoreInputs {
    pub rst: bool,
    pub enable: bool,
    pub depth: u8,
    pub prepare: bool,
    pub prepare_bank: bool,
    pub in_valid: bool,
    pub in_start: bool,
    pub step_write: bool,
    pub node_write: bool,
    pub table_bank: bool,
    pub width: u16,
    pub centre2: u16,
    pub prepare_row: u16,
    pub in_sample: u16,
    pub table_entry: u16,
    /// 80 bits in 32-bit words, least significant first.
    pub table_data: [u32; 3],
}

/// Its outputs.
#[cfg(feature = "builds")]
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
#[expect(
    missing_docs,
    reason = "the ports of that name in fpga/rtl/core/halfrow_core.v, without those of read-back"
)]
pub struct CoreOutputs {
    pub prepared: bool,
    pub out_valid: bool,
    pub out_start: bool,
    pub out_last: bool,
    pub row_short: bool,
    pub row_long: bool,
    pub row_unprepared: bool,
    pub out_sample: u16,
}

/// The functions of one design.
#[repr(C)]
pub(crate) struct Functions<I, O> {
    create: unsafe extern "C" fn(u32) -> *mut c_void,
    destroy: unsafe extern "C" fn(*mut c_void),
    trace: unsafe extern "C" fn(*mut c_void, *const c_char) -> bool,
    is_traced: unsafe extern "C" fn(*mut c_void) -> bool,
    clock: unsafe extern "C" fn(*mut c_void, *const I, *mut O),
}

unsafe extern "C" {
    pub(crate) safe static halfrow_bridge: Functions<BridgeInputs, BridgeOutputs>;
    pub(crate) safe static halfrow_uart: Functions<UartInputs, UartOutputs>;
    pub(crate) safe static halfrow_fifo: Functions<FifoInputs, FifoOutputs>;
}

#[cfg(feature = "builds")]
unsafe extern "C" {
    pub(crate) safe static halfrow_bridge_four: Functions<BridgeInputs, BridgeOutputs>;
    pub(crate) safe static halfrow_bridge_in: Functions<BridgeInputs, BridgeOutputs>;
    pub(crate) safe static halfrow_bridge_lean: Functions<BridgeInputs, BridgeOutputs>;
    pub(crate) safe static halfrow_core7: Functions<CoreInputs, CoreOutputs>;
    pub(crate) safe static halfrow_core5: Functions<CoreInputs, CoreOutputs>;
    pub(crate) safe static halfrow_core_short: Functions<CoreInputs, CoreOutputs>;
    pub(crate) safe static halfrow_core_short5: Functions<CoreInputs, CoreOutputs>;
}

/// The functions of a board that was compiled separately, and the variable that chooses its fault.
#[cfg(feature = "library")]
pub(crate) struct FaultyFunctions {
    functions: &'static Functions<BridgeInputs, BridgeOutputs>,
    fault: *mut u16,
}

#[cfg(feature = "library")]
impl FaultyBoard {
    /// The board in the shared library `path`.
    ///
    /// # Safety
    /// Loading the library runs code of its own. So it must be one that `scripts/hardware coverage` has built with this crate's
    /// shim. It must be loaded only once in a process: the number of the fault is a variable of the library, which all would
    /// share.
    ///
    /// # Errors
    /// [`LibraryError`] when the file is no such library.
    pub unsafe fn load(path: &Path) -> Result<Self, LibraryError> {
        // SAFETY: the caller makes the same promise.
        Self::of(unsafe { FaultyFunctions::load(path) }, path)
    }
}

#[cfg(feature = "library")]
impl FaultyFunctions {
    /// Loads the library `path`, which then stays loaded.
    ///
    /// # Safety
    /// Like [`FaultyBoard::load`].
    unsafe fn load(path: &Path) -> Result<Self, libloading::Error> {
        // SAFETY: what runs on loading is the start of Verilator's own library, as the caller promises. It is never unloaded,
        // so what it offers stays valid. Its two names are declared in shim/faulty.h with these types.
        unsafe {
            let library = Box::leak(Box::new(libloading::Library::new(path)?));
            let functions =
                *library.get::<*const Functions<BridgeInputs, BridgeOutputs>>(b"halfrow_faulty")?;
            let fault = *library.get::<*mut u16>(b"halfrow_fault")?;
            Ok(Self { functions: &*functions, fault })
        }
    }

    /// Its functions, for a board that is switched on with this fault.
    pub(crate) fn choose(&mut self, fault: u16) -> &'static Functions<BridgeInputs, BridgeOutputs> {
        // SAFETY: it is a variable of the library that only `create` reads, and only the owner of this object calls `create`:
        // the caller of `load` promises that the library is loaded once.
        unsafe { *self.fault = fault };
        self.functions
    }
}

/// A verilated design with the inputs `I` and the outputs `O`.
pub(crate) struct Design<I: 'static, O: 'static> {
    object: *mut c_void,
    functions: &'static Functions<I, O>,
}

// SAFETY: an object is used only by its owner. Verilator keeps everything that belongs to a model in the model's own context,
// and no part of it is bound to a thread.
unsafe impl<I, O> Send for Design<I, O> {}

impl<I, O: Default> Design<I, O> {
    /// A design with registers and memories that hold what `seed` draws.
    pub(crate) fn new(functions: &'static Functions<I, O>, seed: u32) -> Self {
        // SAFETY: the function takes any number and returns an object that belongs to the caller.
        Self { object: unsafe { (functions.create)(seed) }, functions }
    }

    /// Lets the inputs settle, then lets the clock rise. The outputs are those that a register samples at this edge; for a
    /// design with pins, those after the edge.
    pub(crate) fn clock(&mut self, inputs: &I) -> O {
        let mut outputs = O::default();
        // SAFETY: the object is alive, and both structures outlive the call.
        unsafe { (self.functions.clock)(self.object, inputs, &raw mut outputs) };
        outputs
    }

    /// From now on writes a waveform to `path`, in VCD. Returns whether the file could be opened.
    pub(crate) fn trace(&mut self, path: &Path) -> bool {
        let Ok(path) = CString::new(path.as_os_str().as_bytes()) else { return false };
        // SAFETY: the object is alive, and the string outlives the call.
        unsafe { (self.functions.trace)(self.object, path.as_ptr()) }
    }

    /// Whether all of the waveform until now is in its file; true if there is none.
    pub(crate) fn is_traced(&mut self) -> bool {
        // SAFETY: the object is alive.
        unsafe { (self.functions.is_traced)(self.object) }
    }
}

impl<I, O> Drop for Design<I, O> {
    fn drop(&mut self) {
        // SAFETY: the object came from this design's `create`, and is destroyed once.
        unsafe { (self.functions.destroy)(self.object) };
    }
}
