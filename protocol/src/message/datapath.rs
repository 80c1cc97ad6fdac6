//! Which arithmetic a board computes.

use core::fmt;

macro_rules! datapaths {
    ($($(#[$doc:meta])* $name:ident = $id:literal,)*) => {
        /// A known datapath: which tables a board takes, what it computes from them, bit for bit, and when.
        ///
        /// No code matches on this with a wildcard, so that the compiler shows whoever adds a datapath every place that must
        /// decide about it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u16)]
        pub enum Datapath {
            $($(#[$doc])* $name = $id,)*
        }

        impl Datapath {
            /// Every known datapath.
            pub const ALL: &[Self] = &[$(Self::$name,)*];
        }

        impl TryFrom<u16> for Datapath {
            type Error = UnknownDatapath;

            fn try_from(id: u16) -> Result<Self, UnknownDatapath> {
                match id {
                    $($id => Ok(Self::$name),)*
                    id => Err(UnknownDatapath { id }),
                }
            }
        }
    };
}

datapaths! {
    /// DATAPATH.md: one row factor per row, and a kernel.
    RowFactors = 1,
    /// DATAPATH.md, *Datapath 2*: a grid of factors, and a kernel.
    Grids = 2,
}

impl Datapath {
    /// The id, by which boards, files and reports name it.
    #[must_use]
    pub const fn id(self) -> u16 {
        self as u16
    }
}

impl fmt::Display for Datapath {
    /// The id.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.id().fmt(f)
    }
}

/// This program does not know the datapath of this number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "datapath {id} is not known here; load a bitstream of a known one, or install a halfrow that knows {id}"
)]
pub struct UnknownDatapath {
    /// The id.
    pub id: u16,
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    /// WIRE.md, tags 01 and 12: DATAPATH.md describes 1 and 2.
    #[test]
    fn the_datapaths_that_are_described_are_known_and_no_other() {
        let known: Vec<u16> = (0..=u16::MAX).filter(|&id| Datapath::try_from(id).is_ok()).collect();
        assert_eq!(known, [1, 2]);
        assert_eq!(Datapath::try_from(3), Err(UnknownDatapath { id: 3 }));
    }

    #[test]
    fn every_datapath_is_found_by_its_id() {
        for &datapath in Datapath::ALL {
            assert_eq!(Datapath::try_from(datapath.id()), Ok(datapath));
        }
    }
}
