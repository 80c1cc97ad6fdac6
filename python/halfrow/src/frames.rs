//! Frames in files, and frames as pictures.

use std::path::PathBuf;

use halfrow::call::Files;
use halfrow::frames::{self, Format, RawGeometry, RawLayout, ReadOptions, UnknownLayout, preview};
use halfrow::model::Frame;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods as _, PyUntypedArrayMethods as _};
use pyo3::prelude::*;

use crate::{arguments, arrays, choices, errors, outputs};

/// Reads the frame in the file `path`: uint16 of shape (height, width), each sample 0 to 2^bits − 1.
///
/// The file's bytes determine its format: PGM, PNG, TIFF, DNG, JPEG, WebP, BMP. Raw samples are taken as they are, never
/// rescaled; a colour picture is mosaicked in `phase`. `raw` (u8, u16le, mipi10, mipi12) is the layout of a file without a
/// header, which also needs `width` and `height`. Raises InputError when the file cannot be read or holds no such frame.
#[pyfunction]
#[pyo3(signature = (path, *, bits = 12, phase = "grbg", raw = None, width = None, height = None))]
pub(crate) fn read_frame<'py>(
    py: Python<'py>,
    #[pyo3(from_py_with = arguments::path)] path: PathBuf,
    #[pyo3(from_py_with = arguments::bits)] bits: u32,
    phase: &str,
    raw: Option<&str>,
    #[pyo3(from_py_with = arguments::width)] width: Option<usize>,
    #[pyo3(from_py_with = arguments::height)] height: Option<usize>,
) -> PyResult<Bound<'py, PyArray2<u16>>> {
    let raw = match (raw, width, height) {
        (None, None, None) => None,
        (Some(layout), Some(width), Some(height)) => {
            let layout: RawLayout = layout.parse().map_err(errors::input::<UnknownLayout>)?;
            Some(RawGeometry { width, height, layout })
        }
        _ => {
            return Err(errors::conflict(
                "raw, width and height belong together; give all of them for a file without a header, or none",
            ));
        }
    };
    let how = ReadOptions {
        depth: choices::depth(bits)?,
        phase: choices::phase(phase)?,
        raw,
        ..ReadOptions::default()
    };
    let frame = py.detach(|| frames::read(&path, &how)).map_err(errors::input)?;
    array(py, frame)
}

/// Writes `frame`, uint16 of shape (height, width), to the file `path`, in the format of its extension: .pgm, .png, .tif, .dng,
/// or .raw (16 bits, low byte first). The file is whole or as before; an existing one is replaced only with `overwrite`.
#[pyfunction]
#[pyo3(signature = (path, frame, *, bits = 12, phase = "grbg", overwrite = false))]
pub(crate) fn write_frame(
    py: Python<'_>,
    #[pyo3(from_py_with = arguments::path)] path: PathBuf,
    frame: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = arguments::bits)] bits: u32,
    phase: &str,
    overwrite: bool,
) -> PyResult<()> {
    let frame = frame_of(frame, "frame", bits, phase)?;
    Format::of(&path).map_err(errors::input)?;
    outputs::check_files(Files::new(overwrite), [&path])?;
    py.detach(|| frames::write(&path, &frame, overwrite)).map_err(errors::failed)
}

/// A picture of `frame` for viewing: uint8 of shape (height, width, 3), red, green and blue coded as sRGB. Each missing colour is
/// the mean of its neighbours. Neither black level nor white balance is applied.
#[pyfunction]
#[pyo3(signature = (frame, *, bits = 12, phase = "grbg"))]
pub(crate) fn demosaic<'py>(
    py: Python<'py>,
    frame: &Bound<'py, PyAny>,
    #[pyo3(from_py_with = arguments::bits)] bits: u32,
    phase: &str,
) -> PyResult<Bound<'py, PyArray3<u8>>> {
    let frame = frame_of(frame, "frame", bits, phase)?;
    let picture = py.detach(|| preview::demosaic(&frame));
    PyArray1::from_vec(py, picture.data).reshape([picture.height, picture.width, 3])
}

/// The frame that the array `what` of a call holds.
pub(crate) fn frame_of(array: &Bound<'_, PyAny>, what: &str, bits: u32, phase: &str) -> PyResult<Frame> {
    let samples = arrays::read(array, what)?;
    let (width, samples) = (samples.shape()[1], samples.as_slice()?.to_vec());
    Frame::new(width, choices::depth(bits)?, choices::phase(phase)?, samples).map_err(errors::input)
}

/// The samples of `frame` as an array, without a copy.
pub(crate) fn array(py: Python<'_>, frame: Frame) -> PyResult<Bound<'_, PyArray2<u16>>> {
    let shape = [frame.height(), frame.width()];
    PyArray1::from_vec(py, frame.into_samples()).reshape(shape)
}
