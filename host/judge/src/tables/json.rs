//! The table file and the kernel file.

use std::io;
use std::path::Path;

use halfrow_model::{
    BitDepth, Geometry, GridShape, Kernel, MAX_HEIGHT, MAX_WIDTH, MIN_WIDTH, NODES, RowFactor, TableSet,
    WEIGHT_NAMES,
};
use halfrow_protocol::message::Datapath;
use serde_json::{Map, Value};

use super::members::{Members, list, number};
use super::{ContentError, Place, TableFileError, layout, mem};
use crate::call::Input;
use halfrow_files::text;
use halfrow_files::written_aside::{WriteAsideError, write_aside};

/// A table file: everything that a board is given before frames.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFile {
    /// The row factors or the grid, and the geometry they are for.
    pub tables: TableSet,
    /// The interpolation weights.
    pub kernel: Kernel,
    /// The user's notes: kept, never interpreted.
    pub about: Option<Map<String, Value>>,
}

/// A kernel file: interpolation weights for any geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct KernelFile {
    /// The interpolation weights.
    pub kernel: Kernel,
    /// The user's notes: kept, never interpreted.
    pub about: Option<Map<String, Value>>,
}

impl TableFile {
    /// The keys of a file with row factors, in the order of the file.
    pub(super) const KEYS: [Place; 8] = [
        Place::Datapath,
        Place::About,
        Place::Width,
        Place::Height,
        Place::Bits,
        Place::Centre2,
        Place::RowFactors,
        Place::Kernel,
    ];
    /// The keys of a file with a grid, in the order of the file.
    pub(super) const GRID_KEYS: [Place; 10] = [
        Place::Datapath,
        Place::About,
        Place::Width,
        Place::Height,
        Place::Bits,
        Place::Centre2,
        Place::V,
        Place::K,
        Place::Grid,
        Place::Kernel,
    ];

    /// The table file `path`, and what it was read from.
    ///
    /// # Errors
    /// [`TableFileError`] when it cannot be read or [`Self::parse`] refuses its text.
    pub fn read(path: &Path) -> Result<(Self, Input), TableFileError> {
        read(path, Self::parse)
    }

    /// The table file with the content `text`.
    ///
    /// # Errors
    /// [`ContentError`] for the first thing that is wrong: the JSON, the datapath, the keys, the geometry, the row factors from
    /// the top or the grid, then the nodes from x = 0.
    pub fn parse(text: &str) -> Result<Self, ContentError> {
        let members = Members::parse(text)?;
        match members.datapath()? {
            // A missing datapath is reported after unknown keys.
            None | Some(Datapath::RowFactors) => Self::of_row_factors(members),
            Some(Datapath::Grids) => Self::of_grid(members),
        }
    }

    fn of_row_factors(mut members: Members) -> Result<Self, ContentError> {
        members.check_keys(&Self::KEYS)?;
        members.take(Place::Datapath)?;
        let geometry = geometry(&mut members)?;
        let row_factors = row_factors(&members.take(Place::RowFactors)?, geometry.height())?;
        Ok(Self {
            tables: TableSet::from_units(geometry, &row_factors)?,
            kernel: kernel(&members.take(Place::Kernel)?)?,
            about: members.take_about()?,
        })
    }

    fn of_grid(mut members: Members) -> Result<Self, ContentError> {
        members.check_keys(&Self::GRID_KEYS)?;
        members.take(Place::Datapath)?;
        let geometry = geometry(&mut members)?;
        let v = members.take_number(Place::V, &GridShape::V)?;
        let k = members.take_number(Place::K, &GridShape::K)?;
        let shape = GridShape::new(v, k)?;
        let entries = grid(&members.take(Place::Grid)?, shape.entries(&geometry))?;
        Ok(Self {
            tables: TableSet::from_grid(geometry, shape, &entries)?,
            kernel: kernel(&members.take(Place::Kernel)?)?,
            about: members.take_about()?,
        })
    }

    /// The file's text. [`Self::parse`] gives the same tables back.
    #[must_use]
    pub fn to_json(&self) -> String {
        layout::table_file(self)
    }

    /// Writes the file `path`. When that fails, the file is left as it was.
    ///
    /// # Errors
    /// [`WriteAsideError`] when the file exists and `overwrite` is false, or it cannot be written.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
        write_text(path, overwrite, &self.to_json())
    }
}

impl KernelFile {
    /// The keys, in the order of the file.
    pub(super) const KEYS: [Place; 3] = [Place::Datapath, Place::About, Place::Kernel];

    /// The kernel file `path`, and what it was read from.
    ///
    /// # Errors
    /// [`TableFileError`] when it cannot be read or [`Self::parse`] refuses its text.
    pub fn read(path: &Path) -> Result<(Self, Input), TableFileError> {
        read(path, Self::parse)
    }

    /// The kernel file with the content `text`.
    ///
    /// # Errors
    /// [`ContentError`] for the first thing that is wrong, like [`TableFile::parse`]; `datapath` may be missing.
    pub fn parse(text: &str) -> Result<Self, ContentError> {
        let mut members = Members::parse(text)?;
        match members.datapath()? {
            // A kernel is the same for both.
            None | Some(Datapath::RowFactors | Datapath::Grids) => members.check_keys(&Self::KEYS)?,
        }
        Ok(Self { kernel: kernel(&members.take(Place::Kernel)?)?, about: members.take_about()? })
    }

    /// The file's text. [`Self::parse`] gives the same kernel back.
    #[must_use]
    pub fn to_json(&self) -> String {
        layout::kernel_file(self)
    }

    /// Writes the file `path`. When that fails, the file is left as it was.
    ///
    /// # Errors
    /// [`WriteAsideError`] when the file exists and `overwrite` is false, or it cannot be written.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<(), WriteAsideError> {
        write_text(path, overwrite, &self.to_json())
    }
}

fn read<T>(path: &Path, parse: fn(&str) -> Result<T, ContentError>) -> Result<(T, Input), TableFileError> {
    read_json(path, parse).map_err(|error| match mem::is_name(path) && !is_of_json(path) {
        true => TableFileError::MemoryImages { path: path.to_owned() },
        false => error,
    })
}

/// Whether the file begins like JSON, whatever its name, or exists and may not be read.
fn is_of_json(path: &Path) -> bool {
    match text::read(path, text::MAX_BYTES) {
        Ok(text) => text.trim_start().starts_with('{'),
        Err(error) => error.kind() == io::ErrorKind::PermissionDenied,
    }
}

fn read_json<T>(
    path: &Path,
    parse: fn(&str) -> Result<T, ContentError>,
) -> Result<(T, Input), TableFileError> {
    let text = text::read(path, text::MAX_BYTES)
        .map_err(|source| TableFileError::Io { path: path.to_owned(), source })?;
    match parse(&text) {
        Ok(content) => Ok((content, Input::of_bytes(path, text.as_bytes()))),
        Err(source) => Err(TableFileError::content(path.to_owned(), source)),
    }
}

fn write_text(path: &Path, overwrite: bool, text: &str) -> Result<(), WriteAsideError> {
    write_aside(path, overwrite, |out| io::Write::write_all(out, text.as_bytes()))
}

fn geometry(members: &mut Members) -> Result<Geometry, ContentError> {
    let width = members.take_number(Place::Width, &(MIN_WIDTH..=MAX_WIDTH))?;
    let height = members.take_number(Place::Height, &(1..=MAX_HEIGHT))?;
    let bits = members.take_number(Place::Bits, &(0..=u32::MAX))?;
    let depth = BitDepth::from_bits(bits).ok_or(ContentError::Bits { found: bits })?;
    let centre2 = members.take_number(Place::Centre2, &(0..=2 * width as u32 - 2))?;
    Ok(Geometry::new(width, height, depth, centre2)?)
}

fn row_factors(value: &Value, height: usize) -> Result<Vec<u32>, ContentError> {
    let values = list(Place::RowFactors, value, height)?.iter().enumerate();
    values.map(|(row, value)| number(Place::RowFactor { row }, value, &RowFactor::RANGE)).collect()
}

fn grid(value: &Value, entries: usize) -> Result<Vec<u32>, ContentError> {
    let values = list(Place::Grid, value, entries)?.iter().enumerate();
    values.map(|(entry, value)| number(Place::GridEntry { entry }, value, &TableSet::GRID_RANGE)).collect()
}

fn kernel(value: &Value) -> Result<Kernel, ContentError> {
    let nodes = list(Place::Kernel, value, NODES)?.iter().enumerate();
    let nodes: Result<_, _> = nodes.map(|(node, value)| weights(node, value)).collect();
    Ok(Kernel::from_nodes(nodes?)?)
}

fn weights(node: usize, value: &Value) -> Result<[i16; 5], ContentError> {
    let values = list(Place::Node { node }, value, WEIGHT_NAMES.len())?;
    let mut weights = [0; WEIGHT_NAMES.len()];
    for ((place, value), weight) in weights.iter_mut().zip(values).zip(WEIGHT_NAMES) {
        *place = number(Place::Weight { node, weight }, value, &(i16::MIN..=i16::MAX))?;
    }
    Ok(weights)
}
