//! Tables: what a board gets beside frames.

use std::path::PathBuf;

use halfrow::call::{Files, Input};
use halfrow::model::{Interpolant, RowFactor};
use halfrow::optics::{self, Chosen, Optics, TablesBy, View};
use halfrow::progress::Progress;
use halfrow::tables::{TableFile, TableFormat, datapath_of, mem};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use serde_json::{Map, Value};

use crate::choices::{self, OfGrid};
use crate::kernel::{Kernel, KernelLike};
use crate::lens::{Lens, LensLike};
use crate::watched::watched;
use crate::{arguments, errors, outputs};

/// The name of a kernel that comes with a table file.
const OF_FILE: &str = "the table file's";

/// Row factors or a grid of factors, with a kernel, for frames of some size. Made by `from_lens` or `read`.
#[pyclass(frozen, module = "halfrow")]
pub(crate) struct Tables {
    pub(crate) chosen: Chosen,
    /// The notes of the table file; none if its kernel was replaced, since they may describe that.
    about: Option<Map<String, Value>>,
    /// Their kernel, with what is known of it beside its weights.
    pub(crate) kernel: Kernel,
    /// The files that they were read from.
    pub(crate) files: Vec<Input>,
}

#[pymethods]
impl Tables {
    /// The tables for `lens`: a Lens, a lens file, "equidistant:RADIUS", or the paper's lens.
    ///
    /// `projection` is "rows", one factor per row, or "exact", a grid of at most `entries` entries (default 2048), for boards
    /// with datapath 2; `nodes_every` is 32 or 64, for one that takes only grids with a node every so many columns. `rows` says
    /// how row factors are found: "fitted" (the default for a lens file) or "equation-9" (the default for other lenses). `kernel`
    /// is a Kernel, one of `halfrow.KERNELS`, or a kernel file. Ctrl-C, or any signal handler that raises, raises here at once; a
    /// grid that is being found then is so in the background. Raises InputError.
    #[staticmethod]
    #[pyo3(signature = (lens = None, *, projection = "rows", rows = None, entries = None, nodes_every = None, kernel = None))]
    fn from_lens(
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::lens)] lens: Option<LensLike<'_>>,
        projection: &str,
        rows: Option<&str>,
        #[pyo3(from_py_with = arguments::entries)] entries: Option<usize>,
        #[pyo3(from_py_with = arguments::nodes_every)] nodes_every: Option<usize>,
        #[pyo3(from_py_with = arguments::kernel)] kernel: Option<KernelLike<'_>>,
    ) -> PyResult<Self> {
        let mut optics = match lens {
            Some(lens) => lens.taken(py)?,
            None => Lens::seen(py, None, &View::default())?.optics,
        };
        optics.by = choices::tables_by(rows, projection, &OfGrid { entries, nodes_every }, optics.by)?;
        let chosen = match optics.by {
            // This may take many seconds, which nothing can end early.
            TablesBy::Exact { .. } => {
                watched(py, None, None, move |_: &dyn Progress| optics::choose(None, optics, None))?
            }
            TablesBy::Fitting | TablesBy::Equation9 => py.detach(|| optics::choose(None, optics, None)),
        };
        let chosen = chosen.map_err(errors::optics)?;
        let from = chosen.optics.source_of(&chosen.tables);
        let kernel = kernel.unwrap_or_else(|| KernelLike::Name(Interpolant::Hermite.name().into()));
        let files = chosen.optics.file.iter().cloned().collect();
        Self::with_kernel(py, chosen, &from, Some(kernel), files)
    }

    /// The tables in a file that `write` or `halfrow tables` has written: NAME.json, or for two files with memory images
    /// NAME.mem or either of the two.
    ///
    /// `kernel` replaces the file's. Raises InputError, which names the file and the place in it.
    #[staticmethod]
    #[pyo3(signature = (path, *, kernel = None))]
    fn read(
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::path)] path: PathBuf,
        #[pyo3(from_py_with = arguments::kernel)] kernel: Option<KernelLike<'_>>,
    ) -> PyResult<Self> {
        let (mut file, files) = if TableFormat::of(&path) == Ok(TableFormat::Mem) {
            let (tables, kernel, inputs) = py.detach(|| mem::read(&path)).map_err(errors::optics)?;
            (TableFile { tables, kernel, about: None }, inputs.to_vec())
        } else {
            let (file, input) = py.detach(|| TableFile::read(&path)).map_err(errors::optics)?;
            (file, vec![input])
        };
        let about = file.about.take().filter(|_| kernel.is_none());
        let optics = Optics::paper_lens_for(file.tables.geometry());
        let chosen = optics.and_then(|optics| optics::choose(Some((&path, file)), optics, None));
        let chosen = chosen.map_err(errors::optics)?;
        let from = path.display().to_string();
        Ok(Self { about, ..Self::with_kernel(py, chosen, &from, kernel, files)? })
    }

    /// Writes them with their kernel to NAME.json, with the notes of the file that they were read from, or for NAME.mem to two
    /// files with memory images. Existing files are replaced only with `overwrite`, and those that they were read from never: the
    /// lens's, the tables' or the kernel's.
    #[pyo3(signature = (path, *, overwrite = false))]
    fn write(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::path)] path: PathBuf,
        overwrite: bool,
    ) -> PyResult<()> {
        let format = TableFormat::of(&path).map_err(errors::input)?;
        let read = self.files.iter().map(|file| &file.path);
        let files = self.kernel.read_by(Files::new(overwrite).reads(read));
        outputs::check_files(files, format.places(&path))?;
        let Chosen { tables, kernel, .. } = &self.chosen;
        let file = TableFile { tables: tables.clone(), kernel: kernel.clone(), about: self.about.clone() };
        py.detach(|| format.write(&file, &path, overwrite)).map_err(errors::failed)
    }

    /// Columns of the frames.
    #[getter]
    fn width(&self) -> usize {
        self.chosen.tables.geometry().width()
    }

    /// Rows of the frames.
    #[getter]
    fn height(&self) -> usize {
        self.chosen.tables.geometry().height()
    }

    /// Bits of a sample: 8, 10 or 12.
    #[getter]
    fn bits(&self) -> u32 {
        self.chosen.tables.geometry().depth().bits()
    }

    /// The column of the optical centre, a multiple of a half.
    #[getter]
    fn centre_x(&self) -> f64 {
        f64::from(self.chosen.tables.geometry().centre2()) / 2.0
    }

    /// 1 for one factor per row, 2 for a grid.
    #[getter]
    fn datapath(&self) -> u16 {
        datapath_of(&self.chosen.tables).id()
    }

    /// v and k of a grid: 2^v rows from one grid row to the next, 2^k columns from one node to the next. None for row factors.
    #[getter]
    fn grid_shape(&self) -> Option<(u32, u32)> {
        self.chosen.tables.shape().map(|shape| (shape.v(), shape.k()))
    }

    /// The entries in a board's order, in units of 2^-24: uint32 of shape (entries,). Row factors are one per row.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_vec(py, self.chosen.tables.entries().collect())
    }

    /// The factor of each row, above 0 and up to 1: float64 of shape (height,). None for a grid.
    #[getter]
    fn row_factors<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        let fractions = self.chosen.tables.row_factors()?.iter().copied().map(RowFactor::fraction);
        Some(PyArray1::from_vec(py, fractions.collect()))
    }

    /// The column that each output sample comes from, in the datapath's resolution of 2^-13: float64 of shape (height, width).
    fn sources<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (tables, (height, width)) = (&self.chosen.tables, (self.height(), self.width()));
        let rows = py.detach(|| {
            let of_row = |row| {
                let values = tables.values(row).unwrap_or_default();
                let source = |column| values.source(column);
                (0..width)
                    .map(source)
                    .map(|it| it.base as f64 + (256 * it.node as i32 + it.fraction) as f64 / 8192.0)
                    .collect()
            };
            (0..height).map(of_row).collect::<Vec<Vec<f64>>>()
        });
        Ok(PyArray2::from_vec2(py, &rows)?)
    }

    /// The kernel.
    #[getter]
    fn kernel(&self) -> Kernel {
        self.kernel.clone()
    }

    /// The lens that built-in frames are seen through. For tables from a file, which does not contain it, this is the paper's.
    #[getter]
    fn lens(&self) -> Lens {
        Lens { optics: self.chosen.optics.clone() }
    }

    /// A description of where they come from.
    #[getter]
    fn source(&self) -> &str {
        &self.chosen.source
    }

    fn __repr__(&self) -> String {
        format!("<Tables: {}, {} x {}, {} bits>", self.source(), self.width(), self.height(), self.bits())
    }

    /// Whether a board would get the same tables: the same factors, frame geometry and kernel.
    fn __eq__(&self, other: &Self) -> bool {
        (&self.chosen.tables, &self.chosen.kernel) == (&other.chosen.tables, &other.chosen.kernel)
    }
}

impl Tables {
    /// The tables for the paper's lens.
    pub(crate) fn of_paper(py: Python<'_>) -> PyResult<Self> {
        let optics = Lens::seen(py, None, &View::default())?.optics;
        let chosen = optics::choose(None, optics, None).map_err(errors::optics)?;
        Self::with_kernel(py, chosen, "", None, Vec::new())
    }

    /// The tables `chosen`, which come from `from`, with `kernel` if given, else with their own.
    fn with_kernel(
        py: Python<'_>,
        mut chosen: Chosen,
        from: &str,
        kernel: Option<KernelLike<'_>>,
        files: Vec<Input>,
    ) -> PyResult<Self> {
        let kernel = match kernel {
            Some(kernel) => {
                let kernel = kernel.taken(py)?;
                chosen.kernel = kernel.kernel.clone();
                chosen.kernel_file.clone_from(&kernel.file);
                chosen.source = format!("{from}, {} kernel", kernel.name);
                kernel
            }
            None => Kernel {
                kernel: chosen.kernel.clone(),
                about: None,
                name: OF_FILE.to_owned(),
                asked: None,
                file: chosen.kernel_file.clone(),
                came_with: files.iter().map(|file| file.path.clone()).collect(),
            },
        };
        Ok(Self { chosen, about: None, kernel, files })
    }
}
