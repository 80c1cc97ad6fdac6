//! The lenses and sensors on which corrections are compared.

use halfrow::optics::PAPER_FIELD;
use halfrow_model::{
    BitDepth, CalibratedLens, Camera, CameraError, Equidistant, Geometry, LensError, Profile,
};

/// The paper's whole sensor.
pub(super) const SENSOR: (usize, usize) = (2592, 1944);

/// The sensor with which the DSL215 was measured.
pub(super) const MEASURED: (usize, usize) = (752, 480);

/// Pixels of the paper's sensor for one pixel of that sensor: 6.0 µm and 2.2 µm.
const FINER: f64 = 6.0 / 2.2;

/// Column and row of the DSL215's axis in its measurement.
const MEASURED_CENTRE: (f64, f64) = (364.430_465, 229.581_672);

/// Names of the lenses.
pub(super) const PAPER: &str = "the paper's lens";
pub(super) const DSL215: &str = "a measured DSL215";
pub(super) const FISHEYE_MODEL: &str = "OpenCV's fisheye model";

/// An equidistant lens with this radius of the image at 90° from the axis, and its axis at `centre`.
pub(super) fn equidistant(
    size: (usize, usize),
    radius: f64,
    centre: (f64, f64),
) -> Result<Camera, CameraError> {
    camera(size, Equidistant::from_radius(radius)?.into(), centre)
}

/// The paper's lens with its axis in the middle of a frame of this size.
pub(super) fn paper(size: (usize, usize)) -> Result<Camera, CameraError> {
    equidistant(size, Equidistant::default().radius(), middle(size))
}

/// The DSL215 on the sensor of its measurement.
pub(super) fn measured() -> Result<Camera, CameraError> {
    camera(MEASURED, dsl215()?, MEASURED_CENTRE)
}

/// The DSL215 on the paper's pixels, with its axis in the middle.
pub(super) fn dsl215_before(size: (usize, usize)) -> Result<Camera, CameraError> {
    camera(size, dsl215()?.scaled(FINER)?, middle(size))
}

/// The same with its axis off the middle by as much as was measured.
pub(super) fn dsl215_aside(size: (usize, usize)) -> Result<Camera, CameraError> {
    let (was, is) = (middle(MEASURED), middle(size));
    let aside = |is: f64, measured: f64, was: f64| is + FINER * (measured - was);
    let centre = (aside(is.0, MEASURED_CENTRE.0, was.0), aside(is.1, MEASURED_CENTRE.1, was.1));
    camera(size, dsl215()?.scaled(FINER)?, centre)
}

/// A camera of 1280 x 720 with oblong, slanted pixels, in OpenCV's fisheye model (Kannala, Brandt).
pub(super) fn fisheye_model() -> Result<Camera, CameraError> {
    let profile = Profile::KannalaBrandt([-0.0125, 0.0031, -0.0042, 0.0007]);
    let lens = CalibratedLens::new(profile, [[552.25, 0.75], [0.0, 549.125]])?;
    camera((1280, 720), lens, (641.5, 358.25))
}

/// Column and row of a frame's middle.
pub(super) fn middle((width, height): (usize, usize)) -> (f64, f64) {
    ((width - 1) as f64 / 2.0, (height - 1) as f64 / 2.0)
}

/// A Sunex DSL215, measured with OCamCalib and published in ctu-mrs/uvdar_core under the 3-clause BSD licence.
fn dsl215() -> Result<CalibratedLens, LensError> {
    let coefficients = vec![-2.595395e+02, 0.0, 1.626945e-03, -2.328091e-06, 6.601777e-09];
    CalibratedLens::new(Profile::Polynomial(coefficients), [[1.0, -0.000_158], [-0.000_012, 1.000_314]])
}

fn camera(size: (usize, usize), lens: CalibratedLens, centre: (f64, f64)) -> Result<Camera, CameraError> {
    Camera::new(Geometry::centred(size.0, size.1, BitDepth::Twelve)?, lens, centre, PAPER_FIELD)
}
