//! NumPy arrays as frames: taken as they are or refused, never copied.

use std::ops::Range;

use numpy::{
    BorrowError, PyArray2, PyArrayDescrMethods as _, PyArrayMethods as _, PyReadonlyArray2,
    PyReadwriteArray2, PyUntypedArray, PyUntypedArrayMethods as _, dtype,
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

/// The name of the array that takes a result.
pub(crate) const OUT: &str = "out";

/// The samples of `array`, for reading; `what` is its name in the call.
pub(crate) fn read<'py>(array: &Bound<'py, PyAny>, what: &str) -> PyResult<PyReadonlyArray2<'py, u16>> {
    let array = samples(array, what)?;
    array.try_readonly().map_err(|error| refused(error, what))
}

/// The samples of `array`, for writing; `what` is its name in the call.
pub(crate) fn write<'py>(array: &Bound<'py, PyAny>, what: &str) -> PyResult<PyReadwriteArray2<'py, u16>> {
    let array = samples(array, what)?;
    array.try_readwrite().map_err(|error| refused(error, what))
}

/// Makes sure that `out` shares no sample with `frame`. The borrow flags do not show this: they belong to the object that owns
/// the memory, and NumPy makes one such object for each array over a foreign buffer.
pub(crate) fn check_apart(frame: &Bound<'_, PyArray2<u16>>, out: &Bound<'_, PyArray2<u16>>) -> PyResult<()> {
    let (of_frame, of_out) = (addresses(frame), addresses(out));
    let is_apart = of_frame.end <= of_out.start || of_out.end <= of_frame.start;
    if is_apart { Ok(()) } else { Err(PyValueError::new_err(shared(OUT))) }
}

/// The addresses of the samples of a contiguous array.
fn addresses(array: &Bound<'_, PyArray2<u16>>) -> Range<usize> {
    let start = array.data().addr();
    start..start + size_of::<u16>() * array.len()
}

fn refused(error: BorrowError, what: &str) -> PyErr {
    PyValueError::new_err(match error {
        BorrowError::NotWriteable => format!("{what} is read-only; give an array that can be written"),
        _ => shared(what),
    })
}

fn shared(what: &str) -> String {
    format!(
        "{what} shares memory with an array that is in use, its input or another call's; give one of its own"
    )
}

fn samples<'a, 'py>(array: &'a Bound<'py, PyAny>, what: &str) -> PyResult<&'a Bound<'py, PyArray2<u16>>> {
    let Ok(untyped) = array.cast::<PyUntypedArray>() else {
        let kind = array.get_type().name()?;
        let copy = format!("numpy.asarray({what}, numpy.uint16) makes one");
        return Err(PyTypeError::new_err(format!(
            "{what} is a {kind}, not a numpy.ndarray; {}",
            instead(what, copy)
        )));
    };
    if is_masked(array)? {
        let copy = format!("{what}.filled(0) is a copy without one");
        return Err(PyTypeError::new_err(format!(
            "{what} is a masked array, and a frame has no mask; {}",
            instead(what, copy)
        )));
    }
    let (given, wanted) = (untyped.dtype(), dtype::<u16>(array.py()));
    if !given.is_equiv_to(&wanted) {
        let order = given.getattr("str")?;
        let copy = format!("{what}.astype(numpy.uint16) is a copy that does");
        return Err(PyTypeError::new_err(format!(
            "{what} holds {given} ({order}), not uint16 in this computer's byte order; {}",
            instead(what, copy)
        )));
    }
    check_layout(untyped, what)?;
    Ok(array.cast()?)
}

/// Makes sure that the array has rows and columns, whose samples lie one after the other.
fn check_layout(array: &Bound<'_, PyUntypedArray>, what: &str) -> PyResult<()> {
    if array.ndim() != 2 {
        return Err(PyValueError::new_err(format!(
            "{what} has {} dimensions, and a frame has rows and columns; give an array of shape (height, width), a colour \
             picture mosaicked",
            array.ndim()
        )));
    }
    if !(array.is_c_contiguous() && array.is_aligned()) {
        let copy = format!(
            "numpy.ascontiguousarray({what}) is a copy that has, or numpy.array({what}) where they are not aligned"
        );
        return Err(PyValueError::new_err(format!(
            "{what} has its samples not one after the other in memory, row by row; {}",
            instead(what, copy)
        )));
    }
    Ok(())
}

/// What to give instead of an array of the wrong kind: a `copy`, but not for the result, which would then be in the copy alone.
fn instead(what: &str, copy: String) -> String {
    if what == OUT { format!("give {OUT} numpy.empty(frame.shape, numpy.uint16)") } else { copy }
}

/// Whether it is a masked array, whose data alone would be taken.
pub(crate) fn is_masked(array: &Bound<'_, PyAny>) -> PyResult<bool> {
    if array.is_exact_instance_of::<PyUntypedArray>() {
        return Ok(false);
    }
    array.is_instance(&array.py().import("numpy.ma")?.getattr("MaskedArray")?)
}
