//! OpenCV's fisheye model as OpenCV, ROS and Kalibr write it.
//!
//! OpenCV's own files do not name the model. Four coefficients in them are taken for this model's, since OpenCV's plain model has
//! five or more unless a program cuts them off.

use halfrow_model::{CalibratedLens, Profile};

use saphyr::Yaml;

use super::tree::{Keys, documents, number, numbers, without_header};
use super::{LensContentError, LensFile, LensModel, picture_size};
use halfrow_files::text::quoted;

/// The keys under which each part may stand. Case and punctuation do not count.
const MATRIX: [&str; 3] = ["camera_matrix", "K", "intrinsic_matrix"];
const FOUR_INTRINSICS: [&str; 1] = ["intrinsics"];
const DISTORTION: [&str; 5] =
    ["distortion_coefficients", "distortion_coeffs", "dist_coeffs", "D", "distortion_parameters"];
const MODELS: [&str; 2] = ["distortion_model", "camera_model"];
const SIZE: [&str; 4] = ["image_size", "resolution", "img_size", "DIM"];
const WIDTH: [&str; 2] = ["image_width", "width"];
const HEIGHT: [&str; 2] = ["image_height", "height"];

/// Names that mean this model, or leave the model open.
const OUR_NAMES: [&str; 7] =
    ["equidistant", "equi", "fisheye", "kannala_brandt", "kannala_brandt4", "opencv_fisheye", "pinhole"];

pub(super) fn parse(text: &str) -> Result<LensFile, LensContentError> {
    let text = without_header(text);
    let documents = documents(&text)?;
    // A line `---` at the end begins an empty document.
    let documents: Vec<_> = documents.iter().filter(|document| !document.is_null()).collect();
    let lenses = documents.iter().map(|document| lens(document)).collect::<Result<Vec<_>, _>>()?;
    let first = lenses.first().ok_or(LensContentError::NoKeys)?;
    // A camera that publishes its calibration repeatedly still has one lens.
    if lenses.iter().any(|lens| lens != first) {
        return Err(LensContentError::Cameras(format!("{} documents", lenses.len())));
    }
    Ok(first.clone())
}

/// The single lens that a document describes.
fn lens(document: &Yaml<'_>) -> Result<LensFile, LensContentError> {
    let root = Keys::of(document).ok_or(LensContentError::NoKeys)?;
    let cameras = root.cameras();
    match cameras.as_slice() {
        [] => camera(&root),
        [(_, only)] => camera(&Keys::of(only).ok_or(LensContentError::NoKeys)?),
        several => {
            let names: Vec<_> = several.iter().map(|(name, _)| *name).collect();
            Err(LensContentError::Cameras(quoted(&names.join(", "))))
        }
    }
}

fn camera(keys: &Keys<'_>) -> Result<LensFile, LensContentError> {
    let names: [&[&str]; 7] = [&MATRIX, &FOUR_INTRINSICS, &DISTORTION, &MODELS, &SIZE, &WIDTH, &HEIGHT];
    names.concat().into_iter().try_for_each(|name| keys.check_once(name))?;
    let lists: [&[&str]; 5] = [&MATRIX, &DISTORTION, &SIZE, &WIDTH, &HEIGHT];
    lists.into_iter().try_for_each(|names| keys.check_agree(names))?;
    check_model(keys)?;
    let [fx, skew, cx, fy, cy] = matrix(keys)?;
    if fx == 0.0 || fy == 0.0 {
        return Err(LensContentError::FocalLength { fx, fy });
    }
    let coefficients = coefficients(keys)?;
    let size = size(keys)?;
    let lens = CalibratedLens::new(Profile::KannalaBrandt(coefficients), [[fx, skew], [0.0, fy]])?;
    LensFile { model: LensModel::OpenCvFisheye, lens, centre: (cx, cy), size }.with_centre_inside()
}

/// Refuses a file that says that it has another model.
fn check_model(keys: &Keys<'_>) -> Result<(), LensContentError> {
    let named = |name: &str| LensContentError::Model { name: quoted(name) };
    if keys.find(&["xi"]).is_some() {
        return Err(named("omnidirectional (it has `xi`)"));
    }
    for key in MODELS {
        let Some(name) = keys.find(&[key]).and_then(|(_, value)| value.as_str()) else { continue };
        if !OUR_NAMES.iter().any(|ours| ours.eq_ignore_ascii_case(name)) {
            return Err(named(name));
        }
    }
    match keys.find(&["fisheye_model"]) {
        Some((_, value)) if matches!(value.as_integer(), Some(0)) || value.as_bool() == Some(false) => {
            Err(named("a plain one (`fisheye_model` is 0)"))
        }
        _ => Ok(()),
    }
}

/// fx, skew, cx, fy and cy.
fn matrix(keys: &Keys<'_>) -> Result<[f64; 5], LensContentError> {
    let Some((second, said)) = keys.find(&FOUR_INTRINSICS) else { return Ok(nine(keys)?.1) };
    let said = numbers(second, said)?;
    if keys.find(&MATRIX).is_none() {
        let [fx, fy, cx, cy] = said[..] else { return Err(LensContentError::Matrix) };
        return Ok([fx, 0.0, cx, fy, cy]);
    }
    let (first, found) = nine(keys)?;
    let [fx, skew, cx, fy, cy] = found;
    if said == [fx, fy, cx, cy] || said == [fx, skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0] {
        Ok(found)
    } else {
        Err(LensContentError::Twice { first: quoted(first), second: quoted(second) })
    }
}

/// The key of the camera matrix, and its fx, skew, cx, fy and cy.
fn nine<'a>(keys: &Keys<'a>) -> Result<(&'a str, [f64; 5]), LensContentError> {
    let (key, value) = keys.get("camera matrix", &MATRIX)?;
    match numbers(key, value)?[..] {
        [fx, skew, cx, zero, fy, cy, left, middle, one]
            if [zero, left, middle, one] == [0.0, 0.0, 0.0, 1.0] =>
        {
            Ok((key, [fx, skew, cx, fy, cy]))
        }
        _ => Err(LensContentError::Matrix),
    }
}

fn coefficients(keys: &Keys<'_>) -> Result<[f64; 4], LensContentError> {
    let (key, value) = keys.get("distortion coefficients", &DISTORTION)?;
    let found = numbers(key, value)?;
    <[f64; 4]>::try_from(found).map_err(|found| LensContentError::Coefficients {
        found: found.len(),
        name: match found.len() {
            5 => " (plumb_bob, k1 k2 p1 p2 k3)",
            8 => " (rational_polynomial)",
            12 => " (thin prism)",
            14 => " (tilted)",
            _ => "",
        },
    })
}

/// Columns and rows of the pictures. ROS's drivers write 0 x 0 if they do not know them.
fn size(keys: &Keys<'_>) -> Result<Option<(usize, usize)>, LensContentError> {
    let together =
        keys.find(&SIZE).map(|(key, value)| Ok::<_, LensContentError>((key, numbers(key, value)?)));
    let together = together.transpose()?;
    let sides = match (together, sides(keys)) {
        (Some((first, together)), Ok(Some((second, apart)))) if together != apart => {
            return Err(LensContentError::Twice { first: quoted(first), second: quoted(second) });
        }
        (Some((_, together)), _) => together,
        (None, apart) => match apart? {
            Some((_, sides)) => sides.to_vec(),
            None => return Ok(None),
        },
    };
    match sides[..] {
        [0.0, 0.0] => Ok(None),
        [width, height] => picture_size(width, height).map(Some),
        _ => Err(LensContentError::Size),
    }
}

/// Width and height under keys of their own, and the width's key.
fn sides<'a>(keys: &Keys<'a>) -> Result<Option<(&'a str, [f64; 2])>, LensContentError> {
    if keys.find(&WIDTH).is_none() && keys.find(&HEIGHT).is_none() {
        return Ok(None);
    }
    let (width, columns) = keys.get("image width", &WIDTH)?;
    let (height, rows) = keys.get("image height", &HEIGHT)?;
    Ok(Some((width, [number(width, columns)?, number(height, rows)?])))
}
