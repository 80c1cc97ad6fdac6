//! The codes of all errors of the library. A code is never changed and never given to another error; a new error gets a new
//! one. [`lookup`] finds the code of an error, and [`LISTS`] has all codes.

mod files;
mod links;
mod parameter;

use std::error::Error;
use std::io;

use super::{Parameters, Problem};
use crate::board::OpenFailed;
use crate::run::Lack;

pub use parameter::Parameter;

/// The error comes from another library, and has no code of its own.
pub const FOREIGN: &str = "foreign-cause";

/// The code of an error, with its figures and names.
#[derive(Clone, Debug, PartialEq)]
pub struct Coded {
    /// The code.
    pub code: String,
    /// The figures and names, by name.
    pub parameters: Parameters,
}

impl Coded {
    /// The code of an error that has none: [`FOREIGN`].
    #[must_use]
    pub fn foreign() -> Self {
        Self { code: FOREIGN.to_owned(), parameters: Parameters::new() }
    }
}

/// A function that finds the code of an error.
pub(crate) type Lookup = fn(&(dyn Error + 'static)) -> Option<Coded>;

/// The codes of one type of error.
#[derive(Clone, Copy, Debug)]
pub struct CodeList {
    /// The type's name.
    pub error: &'static str,
    /// Each code with the names of its parameters.
    pub codes: &'static [(&'static str, &'static [&'static str])],
}

/// Every code of the library's own errors.
pub const LISTS: [&[CodeList]; 2] = [links::LISTS, files::LISTS];

/// The code of an error of this library or of the system.
#[must_use]
pub fn lookup(error: &(dyn Error + 'static)) -> Option<Coded> {
    if let Some(Problem { code, parameters, .. }) = error.downcast_ref() {
        return Some(Coded { code: code.clone(), parameters: parameters.clone() });
    }
    if let Some(Lack { what, .. }) = error.downcast_ref() {
        return lookup(&**what);
    }
    if let Some(OpenFailed { error, .. }) = error.downcast_ref() {
        return lookup(error);
    }
    links::lookup(error).or_else(|| files::lookup(error)).or_else(|| {
        let error = error.downcast_ref::<io::Error>()?;
        let mut parameters = Parameters::new();
        parameters.insert("os_error".to_owned(), error.raw_os_error().into());
        Some(Coded { code: io_code(error.kind()).to_owned(), parameters })
    })
}

/// The code for what the operating system refused and that has no other.
const IO_FAILED: &str = "io-failed";

/// The codes for what the operating system refuses, each with the kinds of error that it stands for.
const IO: [(&str, &[io::ErrorKind]); 9] = [
    ("io-not-found", &[io::ErrorKind::NotFound]),
    ("io-not-permitted", &[io::ErrorKind::PermissionDenied]),
    ("io-already-there", &[io::ErrorKind::AlreadyExists]),
    ("io-no-space", &[io::ErrorKind::StorageFull, io::ErrorKind::FileTooLarge]),
    ("io-pipe-closed", &[io::ErrorKind::BrokenPipe]),
    ("io-too-late", &[io::ErrorKind::TimedOut]),
    ("io-ends-early", &[io::ErrorKind::UnexpectedEof]),
    ("io-wrong-data", &[io::ErrorKind::InvalidData]),
    (IO_FAILED, &[]),
];

/// The operating system refused an operation. The parameter `os_error` is the system's number, if there is one.
#[must_use]
pub fn io_codes() -> [&'static str; IO.len()] {
    IO.map(|(code, _)| code)
}

fn io_code(kind: io::ErrorKind) -> &'static str {
    IO.iter().find(|(_, kinds)| kinds.contains(&kind)).map_or(IO_FAILED, |(code, _)| code)
}

/// Makes `LISTS` and `lookup` from the codes of types of errors:
/// `Type { Variant [field, …] => "code", Variant (name) => "code", = Variant }`, where `=` stands before variants that say
/// no more than the error that they hold, and `Type [field, …] => "code"` for one code whatever the error says.
#[macro_export]
macro_rules! codes {
    (
        $( $error:ident {
            $( $variant:ident $( [ $($field:ident),+ ] )? $( ( $name:ident ) )? => $code:literal, )*
            $( = $inner:ident, )*
        } )*
        $( ; $whole:ident $( [ $($member:ident),+ ] )? => $one:literal )*
    ) => {
        /// The codes by type.
        pub(crate) const LISTS: &[$crate::result::codes::CodeList] = &[
            $( $crate::result::codes::CodeList {
                error: stringify!($error),
                codes: &[ $( ($code, &[ $($(stringify!($field)),+)? $(stringify!($name))? ]), )* ],
            }, )*
            $( $crate::result::codes::CodeList {
                error: stringify!($whole),
                codes: &[ ($one, &[ $($(stringify!($member)),+)? ]) ],
            }, )*
        ];

        /// The code of an error of these types.
        #[allow(unused_mut, reason = "codes without parameters")]
        pub(crate) fn lookup(
            error: &(dyn std::error::Error + 'static),
        ) -> Option<$crate::result::codes::Coded> {
            #[allow(unused_imports, reason = "codes without parameters")]
            use $crate::result::codes::Parameter as _;
            // A boxed source downcasts to the box, not to what is in it.
            $( let boxed = || error.downcast_ref::<Box<$error>>().map(|error| &**error);
            if let Some(error) = error.downcast_ref::<$error>().or_else(boxed) {
                return match error {
                    $( #[allow(unused_variables, reason = "codes without parameters")]
                    $error::$variant { $($($field,)+)? $(0: $name,)? .. } => {
                        let mut parameters = $crate::result::Parameters::new();
                        $( $( parameters.insert(stringify!($field).to_owned(), $field.parameter()); )+ )?
                        $( parameters.insert(stringify!($name).to_owned(), $name.parameter()); )?
                        Some($crate::result::codes::Coded { code: $code.to_owned(), parameters })
                    } )*
                    $( $error::$inner(inner) => {
                        lookup(inner).or_else(|| $crate::result::codes::lookup(inner))
                    } )*
                };
            } )*
            $( let boxed = || error.downcast_ref::<Box<$whole>>().map(|error| &**error);
            if let Some(error) = error.downcast_ref::<$whole>().or_else(boxed) {
                let mut parameters = $crate::result::Parameters::new();
                let _ = error;
                $( $( parameters.insert(stringify!($member).to_owned(), error.$member.parameter()); )+ )?
                return Some($crate::result::codes::Coded { code: $one.to_owned(), parameters });
            } )*
            None
        }
    };
}
pub use crate::codes;
