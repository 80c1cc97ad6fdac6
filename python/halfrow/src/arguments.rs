//! Arguments of a call. Each is converted to its type, or refused by name.

use std::path::PathBuf;

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods as _};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};

use crate::kernel::KernelLike;
use crate::lens::LensLike;
use crate::tables::Tables;
use crate::{arrays, errors};

/// The longest representation of a value that a message repeats, in bytes.
const LONGEST: usize = 40;

/// What an argument takes that is a path.
const PATH: &str = "a path as str or os.PathLike, as os.fsdecode makes one of bytes";

/// Functions for `from_py_with`, each with the name of the argument that it takes.
macro_rules! arguments {
    ($($name:ident: $kind:ty, $takes:expr;)+) => {$(
        pub(crate) fn $name<'py>(given: &Bound<'py, PyAny>) -> PyResult<$kind> {
            given.extract().map_err(|_| wrong_kind(given, stringify!($name), $takes))
        }
    )+};
}

arguments! {
    board: String, "a target as text, like mock or serial:/dev/ttyUSB1";
    tables: Bound<'py, Tables>, "Tables, as Tables.from_lens or Tables.read makes them";
    lens: Option<LensLike<'py>>, "a Lens, a lens file, or \"equidistant:RADIUS\"";
    name: PathBuf, "one of halfrow.KERNELS, or a kernel file";
    degrees: f64, "an angle in degrees";
    kernel: Option<KernelLike<'py>>, "a Kernel, one of halfrow.KERNELS, or a kernel file";
    path: PathBuf, PATH;
    folder: PathBuf, PATH;
    width: Option<usize>, "a number of columns";
    height: Option<usize>, "a number of rows";
    bits: u32, "8, 10 or 12";
    centre_x: Option<f64>, "a column, counted from 0";
    centre_y: Option<f64>, "a row, counted from 0";
    field_of_view: f64, "an angle in degrees";
    entries: Option<usize>, "the most entries that a grid may have";
    nodes_every: Option<usize>, "32 or 64";
    seed: u64, "a whole number from 0 to 2^64 - 1";
}

/// The `lens` that makes a Lens, and so is none.
pub(crate) fn lens_file(given: &Bound<'_, PyAny>) -> PyResult<Option<PathBuf>> {
    given.extract().map_err(|_| wrong_kind(given, "lens", "a lens file, or \"equidistant:RADIUS\""))
}

/// The `weights` that make a Kernel.
pub(crate) fn weights<'py>(given: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArray2<'py, f64>> {
    let takes = "an array of float64 of shape (65, 5), as numpy.asarray(weights, numpy.float64) makes one";
    let weights: PyReadonlyArray2<'py, f64> =
        given.extract().map_err(|_| wrong_kind(given, "weights", takes))?;
    if arrays::is_masked(given)? {
        return Err(errors::wrong_value(
            "weights is a masked array, and a kernel has no mask; give weights.filled(0), or put right what is masked",
        ));
    }
    // Such an array is read at steps of whole elements. NumPy's own flag allows half of one where the processor does.
    let is_whole = |stride: &isize| stride.unsigned_abs().is_multiple_of(size_of::<f64>());
    if !(weights.is_aligned() && weights.strides().iter().all(is_whole)) {
        return Err(errors::wrong_value(
            "weights is not aligned in memory, like a field of a structured array; give numpy.array(weights), a copy that is",
        ));
    }
    Ok(weights)
}

/// Refuses bytes, which are no path and no frame, as the value of the argument `name`.
pub(crate) fn check_no_bytes(given: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let is_bytes = given.is_instance_of::<PyBytes>() || given.is_instance_of::<PyByteArray>();
    if is_bytes { Err(wrong_kind(given, name, PATH)) } else { Ok(()) }
}

/// Refuses a `progress` that cannot be called.
pub(crate) fn check_progress(given: &Bound<'_, PyAny>) -> PyResult<()> {
    let takes = "a function of three arguments, as help(halfrow.verify) describes it";
    if given.is_callable() { Ok(()) } else { Err(wrong_kind(given, "progress", takes)) }
}

fn wrong_kind(given: &Bound<'_, PyAny>, name: &str, takes: &str) -> PyErr {
    errors::wrong_value(format!("{name} is {}; give {takes}", look(given)))
}

/// A value as Python shows it, or only its type if that would be long.
fn look(given: &Bound<'_, PyAny>) -> String {
    let shown = given.repr().map(|shown| shown.to_string()).ok();
    let shown = shown.filter(|shown| shown.len() <= LONGEST && !shown.contains('\n'));
    shown.unwrap_or_else(|| {
        let kind = given.get_type().name().map_or_else(|_| "unknown".to_owned(), |name| name.to_string());
        format!("of type {kind}")
    })
}
