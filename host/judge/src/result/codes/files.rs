//! The codes of errors of calls, of files, of what is in them, and of the model's own values.

use halfrow_model::{
    CameraError, CorrectError, FrameError, GeometryError, GridRoomError, GridShapeError, KernelError,
    LensError, RowFactorError, TableError, UnavailablePath, UnknownInterpolant, UnknownPath, UnknownPhase,
};

use super::codes;
use crate::call::{FilesError, FrameOfOtherSize, NoTime, VoidOption};
use crate::frames::{
    DecodeError, EncodeError, PackingError, ReadError, UnknownBuiltin, UnknownFormat, UnknownLayout,
    WriteError,
};
use crate::kernels::{DamagedKernel, UnknownKernel};
use crate::lenses::{LensContentError, LensFileError, WrongShape};
use crate::optics::OpticsError;
use crate::report::ReportError;
use crate::tables::{ContentError, MemError, TableFileError, UnknownTableFormat, WrongDatapath};
use halfrow_files::NotRegular;
use halfrow_files::written_aside::{Unfinished, WriteAsideError};

codes! {
    ReadError {
        Io [path] => "frame-file-unreadable",
        TooLong [path] => "frame-file-too-long",
        Decode [path] => "frame-file-not-understood",
    }
    DecodeError {
        Empty => "frame-file-empty",
        UnknownFormat => "frame-format-unknown",
        Unsupported [what, remedy] => "frame-format-not-supported",
        TooLarge [width, height] => "frame-too-large",
        TooManyPixels [width, height] => "picture-has-too-many-pixels",
        OtherSize [width, height, columns, rows] => "picture-of-other-size",
        FittedTooLarge [columns, rows] => "picture-wanted-too-large",
        Truncated [expected, found] => "frame-file-truncated",
        Trailing [extra] => "frame-file-has-more",
        PgmHeader [wanted, offset] => "pgm-header-wrong",
        PgmNumber [wanted, offset, digits] => "pgm-number-too-long",
        PgmMaxval (maxval) => "pgm-maxval-wrong",
        AboveMaxval [row, column, value, maxval] => "sample-above-maxval",
        Photograph [format, reason] => "photograph-damaged",
        Png => "png-damaged",
        PngPalette [row, column, index, colours] => "png-palette-exceeded",
        TiffDirectory [offset] => "tiff-directory-wrong",
        Tiff => "tiff-damaged",
        OtherPhase [found, asked] => "frame-of-other-phase",
        OtherDepth [white, asked] => "frame-of-other-depth",
        TooDeep [row, column, value] => "sample-too-deep",
        = Packing,
        = Frame,
    }
    WriteError {
        Extension [path] => "frame-extension-unknown",
        NotPng [path] => "picture-is-no-png",
        Encode [path] => "frame-not-encoded",
        = File,
    }
    EncodeError {
        Io => "frame-encoder-failed",
        Png => "png-not-encoded",
        Tiff => "tiff-not-encoded",
        = Frame,
    }
    WriteAsideError {
        Exists [path] => "file-exists",
        NotAFile [path] => "file-is-no-regular-one",
        Link [path, to] => "file-is-link",
        Claimed [path] => "file-being-written",
        Io [path] => "file-not-written",
    }
    ReportError {
        Name [path] => "report-folder-has-no-name",
        Exists [path] => "report-exists",
        Link [path, to] => "report-folder-is-link",
        Claimed [path] => "report-being-written",
        NotAReport [path, why] => "folder-is-no-report",
        Protected [path] => "report-folder-protected",
        Immovable [path] => "report-folder-not-replaceable",
        Prepare [path] => "report-folder-not-made",
        Write [path, name] => "report-not-written",
        Place [path] => "report-not-put-in-place",
        Json => "report-json-not-encoded",
        Junit => "report-junit-not-encoded",
        Pictures => "report-pictures-not-encoded",
    }
    FilesError {
        ToStdout [option] => "output-to-stdout",
        InputOverwritten [path, option] => "input-would-be-overwritten",
        OutputsShare [first, second, path] => "outputs-share-a-file",
        Exists [path, option] => "file-in-folder-exists",
        NotAFile [path, option] => "file-in-folder-is-no-file",
        FolderClosed [path, option] => "folder-takes-no-files",
        FolderUnusable [path, option] => "folder-unusable",
        = File,
        = Report,
    }
    TableFileError {
        Io [path] => "table-file-unreadable",
        MemoryImages [path] => "table-file-is-memory-image",
        Datapath [path] => "table-file-of-other-datapath",
        Content [path] => "table-file-wrong",
        Mem [path] => "mem-file-wrong",
    }
    ContentError {
        Truncated [line, column] => "json-truncated",
        Json [line, column] => "json-malformed",
        UnknownKey [key, known] => "table-key-unknown",
        RepeatedKey [key] => "table-key-repeated",
        MissingKey (place) => "table-key-missing",
        Kind [place, found, wanted] => "table-value-of-wrong-kind",
        Range [place, found, allowed] => "table-value-out-of-range",
        Length [place, found, wanted] => "table-list-of-wrong-length",
        Bits [found] => "table-depth-unknown",
        = Datapath,
        = Geometry,
        = Shape,
        = Tables,
        = Kernel,
    }
    MemError {
        Header (place) => "mem-header-wrong",
        WeightOrder [order] => "mem-order-missing",
        Bits [found] => "mem-depth-unknown",
        Word [line, found, digits] => "mem-word-wrong",
        = Datapath,
        = Geometry,
        = Shape,
        = Tables,
        = Kernel,
    }
    OpticsError {
        Kernel [name] => "kernel-not-found",
        Shape [path] => "lens-file-of-other-shape",
        Unfit [path] => "lens-file-unfit",
        OutsideCircle [outside, rows, radius, centre] => "image-circle-misses-frame",
        = Room,
        = Damaged,
        = File,
        = LensFile,
        = Geometry,
        = Lens,
        = Camera,
        = Tables,
    }
    LensFileError {
        Io [path] => "lens-file-unreadable",
        Content [path] => "lens-file-wrong",
    }
    LensContentError {
        Empty => "lens-file-empty",
        Xml => "lens-file-is-xml",
        Syntax [line, column, reason] => "lens-file-malformed",
        NoKeys => "lens-file-without-keys",
        Missing [what, keys] => "lens-key-missing",
        Twice [first, second] => "lens-key-twice",
        Kind [key, found, wanted] => "lens-value-of-wrong-kind",
        Cameras (found) => "lens-file-of-several-cameras",
        Model [name] => "lens-model-unknown",
        Coefficients [found, name] => "lens-coefficients-miscounted",
        Matrix => "lens-matrix-wrong",
        Size => "lens-size-wrong",
        Centre [column, row, columns, rows] => "lens-centre-outside",
        FocalLength [fx, fy] => "lens-focal-length-zero",
        Radius (radius) => "lens-radius-out-of-range",
        Lines [found] => "ocam-lines-missing",
        Count [line, found, what] => "ocam-count-wrong",
        Numbers [line, found, wanted, what] => "ocam-numbers-miscounted",
        Number [line, found] => "ocam-number-malformed",
        Sign (coefficient) => "ocam-sign-wrong",
        Inverse [distance, degrees] => "ocam-inverse-contradicts",
        RowOutside [row] => "lens-row-outside",
        NoFrame [columns, rows, width, height] => "lens-of-no-frame-size",
        = Shape,
        = Lens,
        = Camera,
        = Geometry,
        = Tables,
    }
    ;
    VoidOption [option] => "option-without-effect"
    ;
    NoTime [option] => "option-is-no-time"
    ;
    FrameOfOtherSize [path, width, height, columns, rows] => "frame-of-other-size"
    ;
    WrongShape [columns, rows, width, height] => "lens-of-other-shape"
    ;
    WrongDatapath [found] => "tables-of-other-datapath"
    ;
    PackingError [group, width] => "raw-width-does-not-pack"
    ;
    Unfinished [kept] => "file-not-finished"
    ;
    UnknownBuiltin [name] => "builtin-frame-unknown"
    ;
    UnknownFormat => "file-format-unknown"
    ;
    UnknownLayout => "raw-layout-unknown"
    ;
    UnknownTableFormat [path] => "tables-format-unknown"
    ;
    UnknownKernel => "kernel-unknown"
    ;
    UnknownInterpolant => "interpolant-unknown"
    ;
    DamagedKernel => "kernel-damaged"
    ;
    GeometryError => "geometry-impossible"
    ;
    NotRegular [path] => "input-is-no-regular-file"
    ;
    TableError => "row-factors-impossible"
    ;
    RowFactorError [units] => "row-factor-out-of-range"
    ;
    GridShapeError [v, k] => "grid-shape-impossible"
    ;
    GridRoomError [entries, least, width, height] => "grid-without-room"
    ;
    KernelError => "kernel-impossible"
    ;
    LensError => "lens-impossible"
    ;
    CameraError => "camera-impossible"
    ;
    FrameError => "frame-impossible"
    ;
    CorrectError => "frame-does-not-fit-tables"
    ;
    UnavailablePath => "model-path-not-available"
    ;
    UnknownPath => "model-path-unknown"
    ;
    UnknownPhase => "bayer-phase-unknown"
}
