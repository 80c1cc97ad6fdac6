//! What can be wrong with a table file.

use std::io;
use std::path::PathBuf;

use halfrow_model::{GeometryError, GridShapeError, KernelError, TableError};

use halfrow_protocol::message::Datapath;

use super::Place;

/// A file that holds no tables that can be used. The source says where and what to do.
#[derive(Debug, thiserror::Error)]
pub enum TableFileError {
    /// The table file could not be read, is not text, or is longer than any table file.
    #[error("cannot read {}; check that it is the file you mean and that you may read it", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The file is a memory image for Verilog, or named like one, and not a table file or a kernel file.
    #[error("{} is a name of memory images, which are for Verilog; for tables give the table file (.json), for a kernel its file or name", path.display())]
    MemoryImages {
        /// The file.
        path: PathBuf,
    },
    /// The table file is for a datapath that this program cannot judge.
    #[error("{} is refused", path.display())]
    Datapath {
        /// The file.
        path: PathBuf,
        /// Which datapath.
        source: WrongDatapath,
    },
    /// The content of the table file is wrong; the cause that follows says where.
    #[error("{} cannot be used", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Where and why.
        source: ContentError,
    },
    /// The content of the memory image is wrong; the cause that follows says where.
    #[error("{} cannot be used", path.display())]
    Mem {
        /// The file.
        path: PathBuf,
        /// Where and why.
        source: MemError,
    },
}

impl TableFileError {
    /// The error of the JSON file `path` with the content `source`.
    pub(super) fn content(path: PathBuf, source: ContentError) -> Self {
        match source {
            ContentError::Datapath(source) => Self::Datapath { path, source },
            source => Self::Content { path, source },
        }
    }

    /// The error of the memory image `path` with the content `source`.
    pub(super) fn mem(path: PathBuf, source: MemError) -> Self {
        match source {
            MemError::Datapath(source) => Self::Datapath { path, source },
            source => Self::Mem { path, source },
        }
    }
}

/// The tables are for a datapath that this program does not know.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the tables are for datapath {found}, and this program knows {known} alone; \
     make them again with `halfrow tables`, or use a halfrow that knows datapath {found}",
    known = known()
)]
pub struct WrongDatapath {
    /// The id found.
    pub found: i128,
}

impl WrongDatapath {
    /// The datapath that tables say they are for.
    pub(super) fn check(found: i128) -> Result<Datapath, Self> {
        let id = u16::try_from(found).ok();
        id.and_then(|id| Datapath::try_from(id).ok()).ok_or(Self { found })
    }
}

fn known() -> String {
    Datapath::ALL.iter().map(ToString::to_string).collect::<Vec<_>>().join(" and ")
}

/// Text that is no table file or no kernel file.
#[derive(Debug, thiserror::Error)]
pub enum ContentError {
    /// The JSON text ends too early.
    #[error("it breaks off at line {line}, column {column}; copy or make the file again")]
    Truncated {
        /// The line, from 1.
        line: usize,
        /// The column in bytes, from 1.
        column: usize,
    },
    /// The text is not a JSON object.
    #[error("it is not the JSON object it should be at line {line}, column {column}; mend it there")]
    Json {
        /// The line, from 1.
        line: usize,
        /// The column in bytes, from 1.
        column: usize,
        /// What the JSON reader found.
        source: serde_json::Error,
    },
    /// The tables are for another datapath.
    #[error(transparent)]
    Datapath(#[from] WrongDatapath),
    /// The file has a key that does not belong there.
    #[error(
        "it has the key {key:?}, and the keys are {known}; correct or remove it, or put notes into `about`"
    )]
    UnknownKey {
        /// The key.
        key: String,
        /// The keys that there are.
        known: String,
    },
    /// The file has the same key twice.
    #[error("it has the key {key:?} twice; remove one")]
    RepeatedKey {
        /// The key.
        key: String,
    },
    /// The file lacks a key.
    #[error("it lacks {0}; {remedy}", remedy = .0.remedy())]
    MissingKey(Place),
    /// A value in the file is of the wrong kind.
    #[error("{place} is {found}, not {wanted}; {remedy}", remedy = place.remedy())]
    Kind {
        /// Where.
        place: Place,
        /// The value, shortened.
        found: String,
        /// The kind that it should be.
        wanted: &'static str,
    },
    /// A number in the file is too small or too large.
    #[error("{place} is {found}, outside {allowed}; {remedy}", remedy = place.remedy())]
    Range {
        /// Where.
        place: Place,
        /// The number.
        found: i128,
        /// The least and the largest that it can be.
        allowed: String,
    },
    /// A list in the file has too few or too many entries.
    #[error("{place} has {found} entries instead of {wanted}; {remedy}", remedy = place.remedy())]
    Length {
        /// Where.
        place: Place,
        /// Entries there.
        found: usize,
        /// Entries that should be there.
        wanted: usize,
    },
    /// The table file gives a sample depth that the datapath does not have.
    #[error("{place} is {found}; {remedy}", place = Place::Bits, remedy = Place::Bits.remedy())]
    Bits {
        /// The bits given.
        found: u32,
    },
    /// The numbers make no geometry.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The numbers make no grid.
    #[error(transparent)]
    Shape(#[from] GridShapeError),
    /// The numbers make no table set.
    #[error(transparent)]
    Tables(#[from] TableError),
    /// The numbers make no kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
}

/// Text that is no memory image of tables.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MemError {
    /// The image is for another datapath.
    #[error(transparent)]
    Datapath(#[from] WrongDatapath),
    /// The comment at the head of the memory image lacks a number, or gives two.
    #[error("its comments give no single whole number as `{key}=`; write the file again with `halfrow tables`", key = .0.key())]
    Header(Place),
    /// The comments at the head of a kernel's memory image do not say that its weights are in the core's order.
    #[error("its comments do not say `{order}`; write the file again with `halfrow tables`")]
    WeightOrder {
        /// What they must say.
        order: &'static str,
    },
    /// The memory image gives a sample depth that the datapath does not have.
    #[error("its comments give bits={found}; {remedy}", remedy = Place::Bits.remedy())]
    Bits {
        /// The bits given.
        found: u32,
    },
    /// A line of the memory image is neither a comment nor a word.
    #[error(
        "line {line} is {found:?}, not {digits} hexadecimal digits; write the file again with `halfrow tables`"
    )]
    Word {
        /// The line, from 1.
        line: usize,
        /// The text on it, shortened.
        found: String,
        /// Digits that a word has.
        digits: usize,
    },
    /// The numbers make no geometry.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The comments give no grid.
    #[error(transparent)]
    Shape(#[from] GridShapeError),
    /// The words make no table set.
    #[error(transparent)]
    Tables(#[from] TableError),
    /// The words make no kernel.
    #[error(transparent)]
    Kernel(#[from] KernelError),
}
