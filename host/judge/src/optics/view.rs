//! What a caller says about the frames that a lens images.

use std::path::Path;

use halfrow_model::{BitDepth, CalibratedLens, Camera, CameraError, Equidistant, Geometry, LensError};

use super::{Optics, OpticsError, PAPER_FIELD, PAPER_SIZE, TablesBy};
use crate::call::Input;
use crate::lenses::{LensContentError, LensFile};

/// The frames that a lens images. What is left out comes from the lens file, or else from the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Columns, even, 64 to 2592.
    pub width: Option<usize>,
    /// Rows, 1 to 2048.
    pub height: Option<usize>,
    /// Bits of a sample.
    pub depth: BitDepth,
    /// The column of the lens's axis.
    pub centre_x: Option<f64>,
    /// The row of the lens's axis.
    pub centre_y: Option<f64>,
    /// The angle across the image circle, in degrees, above 0 and at most 360.
    pub field_of_view: f64,
}

impl Default for View {
    fn default() -> Self {
        Self {
            width: None,
            height: None,
            depth: BitDepth::default(),
            centre_x: None,
            centre_y: None,
            field_of_view: PAPER_FIELD,
        }
    }
}

impl View {
    /// Frames of `(width, height)`, unless this view gives another size.
    fn geometry(&self, (width, height): (usize, usize)) -> Result<Geometry, OpticsError> {
        Ok(Geometry::centred(self.width.unwrap_or(width), self.height.unwrap_or(height), self.depth)?)
    }

    /// The lens with its axis at `centre`, unless this view gives another place.
    fn camera(
        &self,
        geometry: Geometry,
        lens: CalibratedLens,
        centre: (f64, f64),
    ) -> Result<Camera, OpticsError> {
        let centre = (self.centre_x.unwrap_or(centre.0), self.centre_y.unwrap_or(centre.1));
        Ok(Camera::new(geometry, lens, centre, self.field_of_view)?)
    }

    fn says_size(&self) -> bool {
        self.width.is_some() || self.height.is_some()
    }

    /// Whether `error` is caused by the lens rather than by this view.
    fn is_innocent_of(&self, error: &CameraError) -> bool {
        match error {
            CameraError::Lens(LensError::FieldOfView(_)) => false,
            // The circle's radius, which the lens has at the paper's field of view and this view at another.
            CameraError::Lens(LensError::Radius(_)) => self.field_of_view == PAPER_FIELD,
            CameraError::Lens(_) => true,
            CameraError::Geometry(_) => self.centre_x.is_none(),
            CameraError::CentreRow(_) => self.centre_y.is_none(),
        }
    }
}

impl Optics {
    /// The lens in the file `path`. What `view` leaves out of the frames' size and axis is as in its calibration, or else the
    /// paper's.
    ///
    /// # Errors
    /// [`OpticsError`] when the file cannot be read, holds no lens, or its lens does not fit such frames.
    pub fn of_file(path: &Path, view: &View, by: TablesBy) -> Result<Self, OpticsError> {
        let (file, input) = LensFile::read(path)?;
        Self::of_lens_file(input, &file, None, view, by)
    }

    /// The lens of `file`, which was read from `input`, like [`Self::of_file`]. With `scale`, the frame's pixels for each pixel
    /// of the calibration, only the lens is taken: the frames have the paper's size and the axis in their middle.
    ///
    /// # Errors
    /// [`OpticsError`] when it does not fit such frames.
    pub fn of_lens_file(
        input: Input,
        file: &LensFile,
        scale: Option<f64>,
        view: &View,
        by: TablesBy,
    ) -> Result<Self, OpticsError> {
        let unfit = |source| OpticsError::Unfit { path: input.path.clone(), source };
        let pictures = file.size.filter(|_| scale.is_none());
        let geometry = view.geometry(pictures.unwrap_or(PAPER_SIZE)).map_err(|error| match error {
            OpticsError::Geometry(error) if !view.says_size() => match pictures {
                Some(size) => unfit(LensContentError::of_pictures(size, error)),
                None => error.into(),
            },
            other => other,
        })?;
        let (lens, centre) = match scale {
            Some(scale) => (file.lens.scaled(scale).map_err(|error| unfit(error.into()))?, geometry.middle()),
            None => file
                .for_frame(geometry.width(), geometry.height())
                .map_err(|source| OpticsError::Shape { path: input.path.clone(), source })?,
        };
        let camera = view.camera(geometry, lens, centre).map_err(|error| match error {
            OpticsError::Camera(error) if view.is_innocent_of(&error) => unfit(error.into()),
            other => other,
        })?;
        Ok(Self::calibrated(camera, file.model, input, by)?)
    }

    /// An equidistant lens. What `view` leaves out is as in frames of the paper's size with the axis in their middle.
    ///
    /// # Errors
    /// [`OpticsError`] when it does not fit such frames.
    pub fn of_equidistant(lens: Equidistant, view: &View, by: TablesBy) -> Result<Self, OpticsError> {
        let geometry = view.geometry(PAPER_SIZE)?;
        let camera = view.camera(geometry, lens.into(), geometry.middle())?;
        Ok(Self::equidistant(camera, lens, view.centre_y, by))
    }

    /// The paper's lens for frames of `geometry`'s size and depth, for tables that name no lens.
    ///
    /// # Errors
    /// Like [`Self::of_equidistant`].
    pub fn paper_lens_for(geometry: &Geometry) -> Result<Self, OpticsError> {
        let (width, height) = (Some(geometry.width()), Some(geometry.height()));
        let view = View { width, height, depth: geometry.depth(), ..View::default() };
        Self::of_equidistant(Equidistant::default(), &view, TablesBy::Equation9)
    }
}
