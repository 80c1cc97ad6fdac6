//! Interpolation kernels.

use std::path::{Path, PathBuf};

use halfrow::call::{Files, Input};
use halfrow::model::{self, Interpolant, Taps, WEIGHT_ONE};
use halfrow::optics;
use halfrow::tables::KernelFile;
use numpy::{PyArray2, PyArrayMethods as _, PyReadonlyArray2};
use pyo3::prelude::*;
use serde_json::{Map, Value};

use crate::{arguments, errors, outputs};

/// An interpolation kernel as a board stores it: 65 nodes of five weights each.
///
/// `name` is one of `halfrow.KERNELS`, by default "hermite", or the path of a kernel file. Raises InputError when it is neither.
#[pyclass(frozen, module = "halfrow")]
#[derive(Clone)]
pub(crate) struct Kernel {
    pub(crate) kernel: model::Kernel,
    /// The notes of its file.
    pub(crate) about: Option<Map<String, Value>>,
    /// Its name.
    #[pyo3(get)]
    pub(crate) name: String,
    /// The name or file by which it was requested; none if it was made from weights.
    pub(crate) asked: Option<PathBuf>,
    /// The file that it was read from.
    pub(crate) file: Option<Input>,
    /// The table files that it came with.
    pub(crate) came_with: Vec<PathBuf>,
}

#[pymethods]
impl Kernel {
    #[new]
    #[pyo3(signature = (name = PathBuf::from(Interpolant::Hermite.name())))]
    fn new(py: Python<'_>, #[pyo3(from_py_with = arguments::name)] name: PathBuf) -> PyResult<Self> {
        let read = py.detach(|| optics::kernel_file(name.as_os_str()));
        let (KernelFile { kernel, about }, file) = read.map_err(errors::optics)?;
        let came_with = Vec::new();
        Ok(Self { kernel, about, name: name.display().to_string(), asked: Some(name), file, came_with })
    }

    /// The kernel with these real weights: an array of float64 of shape (65, 5), with a row for each x = 0, 1/32, …, 2 and the
    /// weights of G0, R1, G4, R5 and G6, each −2 to 2 − 2⁻¹⁴, rounded to 14 fractional bits. The weights of G2 and R3 follow
    /// from them. Arrays that are masked or not aligned are refused.
    #[staticmethod]
    #[pyo3(signature = (weights, *, name = "own"))]
    fn from_weights(
        #[pyo3(from_py_with = arguments::weights)] weights: PyReadonlyArray2<'_, f64>,
        name: &str,
    ) -> PyResult<Self> {
        let weights = weights.as_array();
        if weights.ncols() != model::WEIGHT_NAMES.len() {
            return Err(errors::wrong_value(format!(
                "a node has {} weights; give G0, R1, G4, R5 and G6",
                weights.ncols()
            )));
        }
        let node = |node: usize| std::array::from_fn(|tap| weights[[node, tap]]);
        let nodes: Vec<[f64; 5]> = (0..weights.nrows()).map(node).collect();
        let kernel = model::Kernel::from_weights(&nodes).map_err(errors::input)?;
        let came_with = Vec::new();
        Ok(Self { kernel, about: None, name: name.to_owned(), asked: None, file: None, came_with })
    }

    /// How many samples it reads: 5 or 7.
    #[getter]
    fn taps(&self) -> u8 {
        match self.kernel.taps() {
            Taps::Five => 5,
            Taps::Seven => 7,
        }
    }

    /// The weights: float64 of shape (65, 5), as `from_weights` takes them.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let weights = self.kernel.nodes().as_flattened().iter();
        let weights = weights.map(|&weight| f64::from(weight) / f64::from(WEIGHT_ONE)).collect();
        numpy::PyArray1::from_vec(py, weights).reshape([model::NODES, model::WEIGHT_NAMES.len()])
    }

    /// Writes it to a kernel file (JSON), with the notes of the file that it was read from. An existing file is replaced only
    /// with `overwrite`, and the file that it was read from never.
    #[pyo3(signature = (path, *, overwrite = false))]
    fn write(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::path)] path: PathBuf,
        overwrite: bool,
    ) -> PyResult<()> {
        let file = KernelFile { kernel: self.kernel.clone(), about: self.about.clone() };
        outputs::check_files(self.read_by(Files::new(overwrite)), [&path])?;
        py.detach(|| file.write(&path, overwrite)).map_err(errors::failed)
    }

    fn __repr__(&self) -> String {
        format!("Kernel({:?})", self.name)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.kernel == other.kernel
    }
}

impl Kernel {
    /// `files` with those that it was read from.
    pub(crate) fn read_by(&self, files: Files) -> Files {
        files.reads(&self.came_with).reads_kernel(self.asked.as_deref().map(Path::as_os_str))
    }
}

/// A kernel as a call gives it: a [`Kernel`], or the name or path that makes one.
#[derive(FromPyObject)]
pub(crate) enum KernelLike<'py> {
    Kernel(Bound<'py, Kernel>),
    Name(PathBuf),
}

impl KernelLike<'_> {
    /// The kernel.
    pub(crate) fn taken(self, py: Python<'_>) -> PyResult<Kernel> {
        match self {
            Self::Kernel(kernel) => Ok(kernel.get().clone()),
            Self::Name(name) => Kernel::new(py, name),
        }
    }
}
