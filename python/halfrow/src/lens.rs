//! Lenses, and the frames seen through them.

use std::path::PathBuf;

use halfrow::frames::Builtin;
use halfrow::model::Equidistant;
use halfrow::optics::{EQUIDISTANT, Optics, PAPER_FIELD, TablesBy, View};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::{arguments, choices, errors, frames};

/// A fisheye lens, for frames of some size.
///
/// `lens` is a file of OpenCV's fisheye model (FileStorage, camera_info, camchain) or of OCamCalib, or "equidistant:RADIUS"
/// with the radius of the image of 180 degrees in pixels. The default is the paper's lens, R = 1106.697 pixels.
///
/// `width` (even, 64 to 2592) and `height` (1 to 2048) are by default those of the lens file's pictures, or else 1920 x 1080.
/// Frames of another size scale the lens, and must have the same aspect ratio. `bits` is 8, 10 or 12. `centre_x` and `centre_y`,
/// the column and row of the lens's axis, are by default the file's, or else the middle. `field_of_view` is the angle across the
/// image circle, in degrees, by default 180.
///
/// Raises InputError when a file cannot be read or holds no such lens, or when the lens is not possible with such frames.
#[pyclass(frozen, module = "halfrow")]
pub(crate) struct Lens {
    pub(crate) optics: Optics,
}

#[pymethods]
impl Lens {
    #[new]
    #[pyo3(signature = (
        lens = None, *, width = None, height = None, bits = 12, centre_x = None, centre_y = None, field_of_view = PAPER_FIELD
    ))]
    fn new(
        #[pyo3(from_py_with = arguments::lens_file)] lens: Option<PathBuf>,
        #[pyo3(from_py_with = arguments::width)] width: Option<usize>,
        #[pyo3(from_py_with = arguments::height)] height: Option<usize>,
        #[pyo3(from_py_with = arguments::bits)] bits: u32,
        #[pyo3(from_py_with = arguments::centre_x)] centre_x: Option<f64>,
        #[pyo3(from_py_with = arguments::centre_y)] centre_y: Option<f64>,
        #[pyo3(from_py_with = arguments::field_of_view)] field_of_view: f64,
    ) -> PyResult<Self> {
        let depth = choices::depth(bits)?;
        let view = View { width, height, depth, centre_x, centre_y, field_of_view };
        // A parameter for it would be one too many.
        Python::attach(|py| Self::seen(py, lens, &view))
    }

    /// Columns of the frames.
    #[getter]
    fn width(&self) -> usize {
        self.optics.camera.geometry().width()
    }

    /// Rows of the frames.
    #[getter]
    fn height(&self) -> usize {
        self.optics.camera.geometry().height()
    }

    /// Bits of a sample: 8, 10 or 12.
    #[getter]
    fn bits(&self) -> u32 {
        self.optics.camera.geometry().depth().bits()
    }

    /// Column and row of the axis, counted from 0 at the middle of the first pixel.
    #[getter]
    fn centre(&self) -> (f64, f64) {
        self.optics.camera.centre()
    }

    /// R: columns from the axis to the edge of the image circle.
    #[getter]
    fn radius(&self) -> f64 {
        self.optics.camera.radius()
    }

    /// The angle across the image circle, in degrees.
    #[getter]
    fn field_of_view(&self) -> f64 {
        self.optics.camera.field_of_view().to_degrees()
    }

    /// How many rows are outside the image circle. Row factors do not stretch them, and a grid does not do so exactly.
    #[getter]
    fn rows_outside_circle(&self) -> usize {
        self.optics.camera.rows_outside_circle()
    }

    /// Where a ray `degrees` off the axis is imaged, in columns from the axis; None if the lens does not image it.
    fn column(&self, #[pyo3(from_py_with = arguments::degrees)] degrees: f64) -> Option<f64> {
        self.optics.camera.lens().column(degrees.to_radians())
    }

    /// The built-in frame `name`, one of `halfrow.BUILTIN_FRAMES`, as seen through an equidistant lens that images 90 degrees where
    /// this one does: uint16 of shape (height, width).
    ///
    /// `phase` is grbg, rggb, bggr or gbrg; `seed` is the seed of noise.
    #[pyo3(signature = (name, *, phase = "grbg", seed = 1))]
    fn frame<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        phase: &str,
        #[pyo3(from_py_with = arguments::seed)] seed: u64,
    ) -> PyResult<Bound<'py, PyArray2<u16>>> {
        let builtin: Builtin = name.parse().map_err(errors::input::<halfrow::frames::UnknownBuiltin>)?;
        let scene = self.optics.scene(choices::phase(phase)?, seed);
        let frame = py.detach(|| builtin.render(&scene)).map_err(errors::failed)?;
        frames::array(py, frame)
    }

    fn __repr__(&self) -> String {
        let (optics, geometry) = (&self.optics, self.optics.camera.geometry());
        format!("<Lens: {}, {} x {}>", optics.source(), geometry.width(), geometry.height())
    }
}

impl Lens {
    /// The lens, whose file is read without Python's lock: it may be a pipe that another thread of Python fills.
    pub(crate) fn seen(py: Python<'_>, lens: Option<PathBuf>, view: &View) -> PyResult<Self> {
        let radius = lens.as_ref().and_then(|lens| lens.to_str()?.strip_prefix(EQUIDISTANT));
        let equidistant = match (&lens, radius) {
            (None, _) => Equidistant::default(),
            (Some(_), Some(radius)) => {
                let radius = radius.parse().map_err(|_| {
                    errors::wrong_value(format!(
                        "`{radius}` is no radius; give {EQUIDISTANT}RADIUS, that of the image of 180 degrees in pixels"
                    ))
                })?;
                Equidistant::from_radius(radius).map_err(errors::input)?
            }
            (Some(path), None) => {
                let read = py.detach(|| Optics::of_file(path, view, TablesBy::Fitting));
                return Ok(Self { optics: read.map_err(errors::optics)? });
            }
        };
        let optics =
            Optics::of_equidistant(equidistant, view, TablesBy::Equation9).map_err(errors::optics)?;
        Ok(Self { optics })
    }
}

/// A lens as a call gives it: a [`Lens`], or what makes one.
#[derive(FromPyObject)]
pub(crate) enum LensLike<'py> {
    Lens(Bound<'py, Lens>),
    Name(PathBuf),
}

impl LensLike<'_> {
    /// The lens, with its frames.
    pub(crate) fn taken(self, py: Python<'_>) -> PyResult<Optics> {
        match self {
            Self::Lens(lens) => Ok(lens.get().optics.clone()),
            Self::Name(name) => Ok(Lens::seen(py, Some(name), &View::default())?.optics),
        }
    }
}
