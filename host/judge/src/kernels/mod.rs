//! The kernels that have a name: the paper's interpolants, one that halves the chord's error, and two fitted to photographs.

use std::fmt;
use std::str::FromStr;

use halfrow_model::{Interpolant, Kernel, KernelError};

use crate::tables::{ContentError, KernelFile};

/// The distance between two nodes, in pixels.
const NODE_DISTANCE: f64 = 1.0 / 32.0;

/// A kernel with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedKernel {
    /// The nodes of an interpolant of the paper.
    Interpolant(Interpolant),
    /// Hermite, its nodes shifted so that the chords between them lie on both sides of the curve.
    HermiteBalanced,
    /// Fitted to photographs, five taps.
    Sharp5,
    /// Fitted to photographs, seven taps.
    Sharp7,
}

/// No kernel has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no named kernel; use {known}", known = names(" or "))]
pub struct UnknownKernel(String);

/// A kernel that is built into this program is damaged.
#[derive(Debug, thiserror::Error)]
#[error("the kernel {name} is damaged in this program; build it again from a sound copy, or report it")]
pub struct DamagedKernel {
    /// Its name.
    name: &'static str,
    /// What is wrong with its numbers.
    source: ContentError,
}

/// The names of all named kernels, separated by commas, with `last` before the last one.
#[must_use]
pub fn names(last: &str) -> String {
    let names = NamedKernel::ALL.map(NamedKernel::name);
    match names.split_last() {
        Some((end, others)) => format!("{}{last}{end}", others.join(", ")),
        None => String::new(),
    }
}

impl NamedKernel {
    /// All of them, the paper's first.
    pub const ALL: [Self; 7] = [
        Self::Interpolant(Interpolant::Nearest),
        Self::Interpolant(Interpolant::Linear),
        Self::Interpolant(Interpolant::Keys),
        Self::Interpolant(Interpolant::Hermite),
        Self::HermiteBalanced,
        Self::Sharp5,
        Self::Sharp7,
    ];

    /// The name in the spelling that [`FromStr`] reads.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Interpolant(interpolant) => interpolant.name(),
            Self::HermiteBalanced => "hermite-balanced",
            Self::Sharp5 => "sharp5",
            Self::Sharp7 => "sharp7",
        }
    }

    /// The kernel's weights.
    ///
    /// # Errors
    /// [`DamagedKernel`] when the numbers that the program was built with are no kernel. That cannot happen in a sound build.
    pub fn kernel(self) -> Result<Kernel, DamagedKernel> {
        let made = match self {
            Self::Interpolant(interpolant) => Ok(Kernel::from(interpolant)),
            Self::HermiteBalanced => balanced(Interpolant::Hermite).map_err(ContentError::from),
            Self::Sharp5 => shipped(include_str!("sharp5.json")),
            Self::Sharp7 => shipped(include_str!("sharp7.json")),
        };
        made.map_err(|source| DamagedKernel { name: self.name(), source })
    }
}

fn shipped(text: &str) -> Result<Kernel, ContentError> {
    KernelFile::parse(text).map(|file| file.kernel)
}

/// The nodes of a smooth interpolant, each less a sixteenth of the second difference there, which is f″/32² (DATAPATH.md,
/// "Accuracy").
fn balanced(interpolant: Interpolant) -> Result<Kernel, KernelError> {
    let node = |node: i32| {
        let x = f64::from(node) * NODE_DISTANCE;
        let [before, here, after] =
            [x - NODE_DISTANCE, x, x + NODE_DISTANCE].map(|x| stored(interpolant.weights(x)));
        std::array::from_fn(|tap| here[tap] - (before[tap] - 2.0 * here[tap] + after[tap]) / 16.0)
    };
    let nodes: Vec<[f64; 5]> = (0..65).map(node).collect();
    Kernel::from_weights(&nodes)
}

/// The five weights that a kernel stores, out of seven.
pub fn stored([g0, r1, _, _, g4, r5, g6]: [f64; 7]) -> [f64; 5] {
    [g0, r1, g4, r5, g6]
}

impl fmt::Display for NamedKernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for NamedKernel {
    type Err = UnknownKernel;

    fn from_str(text: &str) -> Result<Self, UnknownKernel> {
        let mut names = Self::ALL.into_iter();
        names
            .find(|kernel| kernel.name().eq_ignore_ascii_case(text))
            .ok_or_else(|| UnknownKernel(text.to_owned()))
    }
}
