//! Frames corrected by the reference model, from array to array.

use std::sync::{Mutex, PoisonError};

use halfrow::model::{self, CorrectError, FrameError, ModelPath, TableSet};
use numpy::{PyArray2, PyUntypedArrayMethods as _};
use pyo3::prelude::*;

use crate::kernel::KernelLike;
use crate::tables::Tables;
use crate::{arguments, arrays, choices, errors};

/// Corrects frames with the reference model, bit for bit as a board must. Several threads may use one Corrector at once.
///
/// `kernel` replaces the tables' own. `path` is one of `halfrow.MODEL_PATHS`, which all give the same bits; the default is the
/// last and fastest.
#[pyclass(frozen, module = "halfrow")]
pub(crate) struct Corrector {
    /// The model's correctors that no call is using.
    idle: Mutex<Vec<model::Corrector>>,
    #[pyo3(get)]
    tables: Py<Tables>,
    kernel: model::Kernel,
    path: ModelPath,
}

#[pymethods]
impl Corrector {
    #[new]
    #[pyo3(signature = (tables, *, kernel = None, path = None))]
    fn new(
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::tables)] tables: Bound<'_, Tables>,
        #[pyo3(from_py_with = arguments::kernel)] kernel: Option<KernelLike<'_>>,
        path: Option<&str>,
    ) -> PyResult<Self> {
        let kernel = match kernel {
            Some(kernel) => kernel.taken(py)?.kernel,
            None => tables.get().chosen.kernel.clone(),
        };
        let path = choices::path(path)?;
        Ok(Self { idle: Mutex::default(), tables: tables.unbind(), kernel, path })
    }

    /// The path of the model that is used.
    #[getter]
    fn path(&self) -> &'static str {
        self.path.name()
    }

    /// The corrected `frame`. Both are uint16 with the tables' shape (height, width) and samples of 0 to 2^bits − 1.
    ///
    /// The result goes into `out`, or else into a new array. Neither array is copied, and no other thread may write to them
    /// meanwhile. Python's lock is released. An array of another kind raises TypeError or ValueError, a frame of another size or
    /// with too bright a sample InputError; the content of `out` is then undefined.
    #[pyo3(signature = (frame, out = None))]
    fn correct<'py>(
        &self,
        py: Python<'py>,
        frame: &Bound<'py, PyAny>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let tables = &self.tables.get().chosen.tables;
        let frame = arrays::read(frame, "frame")?;
        check_size(tables, frame.shape())?;
        let out = match out {
            Some(out) => out,
            None => PyArray2::<u16>::zeros(py, [frame.shape()[0], frame.shape()[1]], false).into_any(),
        };
        let mut written = arrays::write(&out, arrays::OUT)?;
        check_size(tables, written.shape())?;
        arrays::check_apart(&frame, &written)?;
        let (samples, output) = (frame.as_slice()?, written.as_slice_mut()?);
        py.detach(|| self.run(tables, samples, output)).map_err(errors::input)?;
        drop(written);
        Ok(out)
    }
}

impl Corrector {
    fn run(&self, tables: &TableSet, samples: &[u16], output: &mut [u16]) -> Result<(), FrameError> {
        let idle = || self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = idle().pop();
        // `new` has made sure that the path is available.
        let mut corrector = taken
            .or_else(|| model::Corrector::new(self.path, &self.kernel).ok())
            .unwrap_or_else(|| model::Corrector::oracle(&self.kernel));
        let corrected = corrector.correct_samples(tables, samples, output);
        idle().push(corrector);
        corrected
    }
}

fn check_size(tables: &TableSet, shape: &[usize]) -> PyResult<()> {
    let (width, height) = (tables.geometry().width(), tables.geometry().height());
    if shape == [height, width] {
        return Ok(());
    }
    Err(errors::input(CorrectError::Size { frame_width: shape[1], frame_height: shape[0], width, height }))
}

/// The corrected `frame`, like `Corrector(tables, kernel=kernel, path=path).correct(frame, out)`.
#[pyfunction]
#[pyo3(signature = (frame, tables, *, kernel = None, out = None, path = None))]
pub(crate) fn correct<'py>(
    py: Python<'py>,
    frame: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = arguments::tables)] tables: Bound<'py, Tables>,
    #[pyo3(from_py_with = arguments::kernel)] kernel: Option<KernelLike<'py>>,
    out: Option<Bound<'py, PyAny>>,
    path: Option<&str>,
) -> PyResult<Bound<'py, PyAny>> {
    Corrector::new(py, tables, kernel, path)?.correct(py, frame, out)
}
