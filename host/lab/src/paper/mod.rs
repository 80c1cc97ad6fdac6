//! The paper's figures and tables, reproduced, with one module for each item.
//!
//! An item becomes an [`Exhibit`] of claims, tables and pictures. A [`Folder`] takes exhibits as one page, pictures, CSV and
//! JSON. Equations, sections, figures and tables are those of Lai et al., *Real-time distortion correction of fish-eye lens based
//! on Bayer image signal*, Optical Review 2014.

mod cameras;
mod carroll;
mod delay;
mod details;
mod distortion;
mod error;
mod error_map;
mod exhibit;
mod expected;
mod experiment;
mod folder;
mod graticule;
mod interpolants;
mod item;
mod left;
mod lines;
mod marked;
mod outcome;
mod page;
mod photographs;
mod psnr;
mod quality;
mod resources;
mod scene_views;
mod side_by_side;
mod svg;
mod table_1;
mod tested_board;
mod views;
mod ways;

pub use distortion::distorted;
pub(crate) use distortion::distorted_by;
pub use error::PaperError;
pub use exhibit::{Accepted, Cell, Claim, Exhibit, Picture, Table};
pub use folder::{Folder, FolderError, document};
pub use item::Item;
pub use marked::{MarkedError, MarkedPhotograph};
pub use outcome::Outcome;
pub use photographs::{PhotographError, read as read_photographs};
pub(crate) use psnr::psnr;
pub use resources::Synthesis;
pub use tested_board::TestedBoard;
pub use views::{View, ray};

use halfrow_model::Geometry;

use halfrow::frames::preview::RgbImage;
use halfrow::progress::Progress;

/// What items are made from.
#[derive(Debug)]
pub struct Material<'a> {
    /// The 24 photographs; empty if no item needs them.
    pub photographs: &'a [RgbImage],
    /// The photograph that Fig. 4 shows instead of the street.
    pub marked: Option<&'a MarkedPhotograph>,
    /// The board, if one was opened.
    pub board: Option<TestedBoard>,
    /// Whether Table 1 goes through the board too.
    pub through_board: bool,
    /// What `scripts/hardware resources` wrote.
    pub synthesis: &'a Synthesis,
}

impl Material<'_> {
    /// Makes one item.
    ///
    /// # Errors
    /// [`PaperError`] when the board or a file fails.
    pub fn exhibit(&mut self, item: Item, progress: &dyn Progress) -> Result<Exhibit, PaperError> {
        match item {
            Item::Fig3 => graticule::figure_3(),
            Item::Fig4 => scene_views::figure_4(self.marked),
            Item::Fig5 => error_map::exhibit(),
            Item::Fig6 => scene_views::figure_6(),
            Item::Fig8 => Ok(interpolants::exhibit()),
            Item::Fig12 => details::exhibit(self.photographs),
            Item::Table1 => {
                let board = self.board.as_mut().filter(|_| self.through_board);
                table_1::exhibit(self.photographs, board, progress)
            }
            Item::Verticals => side_by_side::exhibit(),
            Item::Residuals => left::exhibit(),
            Item::Delay => {
                let board = self.board.as_mut().ok_or(PaperError::NoBoard)?;
                delay::exhibit(board, progress)
            }
            Item::Resources => Ok(resources::exhibit(self.synthesis)),
        }
    }

    /// The rows that an item computes or streams, for a progress bar.
    #[must_use]
    pub fn rows(&self, item: Item) -> u64 {
        let photographs = (self.photographs.len() * photographs::HEIGHT) as u64;
        match item {
            Item::Table1 if self.through_board => 5 * photographs,
            Item::Table1 => photographs,
            Item::Delay => Geometry::default().height() as u64,
            _ => 0,
        }
    }
}
