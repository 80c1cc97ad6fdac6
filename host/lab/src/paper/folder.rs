//! The folder of the exhibits: the page, a file for each picture and table, and all numbers as JSON.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::exhibit::{Drawing, Exhibit, Picture};
use super::{Item, Outcome, page};
use halfrow::frames::preview;
use halfrow::result::{Document, Schema};
use halfrow_files::written_aside::{Claim, WriteAsideError, check, write_aside};

/// Name of the page.
const PAGE: &str = "paper.html";
/// Name of the file with all numbers.
const NUMBERS: &str = "paper.json";

/// Exhibits that could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder for the paper's figures cannot be made.
    #[error("the folder {} cannot be made; choose another with --output", path.display())]
    Make {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteAsideError),
    /// A picture for the paper cannot be encoded.
    #[error("a picture cannot be encoded; this is a fault of halfrow, so report it")]
    Picture(#[from] png::EncodingError),
}

/// A folder for exhibits. Other files in it stay as they are.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    overwrite: bool,
    /// Kept until everything is written, so that two runs that may not overwrite cannot both begin.
    _claim: Option<Claim>,
}

impl Folder {
    /// Makes the folder unless it exists. Makes sure that it contains no earlier page, unless that may be replaced.
    ///
    /// # Errors
    /// [`FolderError`] when it cannot be made, contains a page, or another run is about to put one there.
    pub fn prepare(path: &Path, overwrite: bool) -> Result<Self, FolderError> {
        fs::create_dir_all(path).map_err(|source| FolderError::Make { path: path.to_owned(), source })?;
        let page = path.join(PAGE);
        let claim = if overwrite { None } else { Some(Claim::take(&page)?) };
        check(&page, overwrite)?;
        Ok(Self { path: path.to_owned(), overwrite, _claim: claim })
    }

    /// The files that `items` may write into `folder`, the page first.
    pub fn files(folder: &Path, items: &[Item]) -> impl Iterator<Item = PathBuf> {
        let of_items = items.iter().flat_map(|item| item.files());
        [PAGE, NUMBERS].iter().chain(of_items).map(|name| folder.join(name))
    }

    /// Writes everything, the page last, and returns the page's path.
    ///
    /// # Errors
    /// [`FolderError`] for the first file that cannot be written.
    pub fn write(&self, exhibits: &[Exhibit]) -> Result<PathBuf, FolderError> {
        // If two runs overwrite each other, all files are those of one of them.
        let _turn = if self.overwrite { Some(Claim::wait(&self.path.join(PAGE))?) } else { None };
        for exhibit in exhibits {
            for table in &exhibit.tables {
                self.file(&format!("{}.csv", table.name), table.csv().as_bytes())?;
            }
            for picture in &exhibit.pictures {
                self.file(&file_name(picture), &encoded(picture)?)?;
            }
        }
        self.file(NUMBERS, format!("{}\n", document(exhibits)).as_bytes())?;
        self.file(PAGE, page::render(exhibits)?.as_bytes())?;
        Ok(self.path.join(PAGE))
    }

    fn file(&self, name: &str, bytes: &[u8]) -> Result<(), FolderError> {
        Ok(write_aside(&self.path.join(name), self.overwrite, |out| out.write_all(bytes))?)
    }
}

/// Every number of every exhibit as a JSON document of the program, indented.
#[must_use]
pub fn document(exhibits: &[Exhibit]) -> String {
    let document = Document {
        schema: Schema,
        command: "paper",
        verdict: None,
        exit_code: Outcome::of(exhibits).exit(),
        board: None,
        error: None,
        rest: numbers(exhibits),
    };
    format!("{:#}", json!(document))
}

fn numbers(exhibits: &[Exhibit]) -> Value {
    let exhibits = exhibits.iter().map(|exhibit| {
        let claims: Vec<Value> = exhibit.claims.iter().map(super::Claim::json).collect();
        let tables: Vec<Value> = exhibit.tables.iter().map(super::Table::json).collect();
        json!({
            "item": exhibit.item.name(), "title": exhibit.item.title(), "remarks": exhibit.remarks,
            "open": exhibit.open,
            "claims": claims, "tables": tables,
        })
    });
    json!({ "halfrow": env!("CARGO_PKG_VERSION"), "items": exhibits.collect::<Vec<Value>>() })
}

/// The name of a picture's file.
pub(super) fn file_name(picture: &Picture) -> String {
    let extension = match picture.drawing {
        Drawing::Pixels(..) => "png",
        Drawing::Lines(_) => "svg",
    };
    format!("{}.{extension}", picture.name)
}

/// A picture as the bytes of its file.
pub(super) fn encoded(picture: &Picture) -> Result<Vec<u8>, png::EncodingError> {
    match &picture.drawing {
        Drawing::Lines(svg) => Ok(svg.clone().into_bytes()),
        Drawing::Pixels(image, _) => {
            let mut bytes = Vec::new();
            preview::encode_png_rgb(image, &mut bytes)?;
            Ok(bytes)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::paper::{Material, Synthesis};
    use halfrow::frames::preview::RgbImage;
    use halfrow::progress::Silent;

    /// Items that need photographs. Tests of the program check the lists of all other items.
    #[test]
    fn items_of_photographs_write_the_files_on_their_lists() {
        let (width, height) = (768, 512);
        let flat = RgbImage { width, height, data: vec![90; 3 * width * height] };
        let (photographs, synthesis) = (vec![flat; 8], Synthesis::none(Path::new("")));
        let mut material = Material {
            photographs: &photographs,
            marked: None,
            board: None,
            through_board: false,
            synthesis: &synthesis,
        };
        for item in Item::ALL.into_iter().filter(|item| item.needs_photographs()) {
            let exhibit = material.exhibit(item, &Silent).unwrap();
            let tables = exhibit.tables.iter().map(|table| format!("{}.csv", table.name));
            let written: BTreeSet<String> = tables.chain(exhibit.pictures.iter().map(file_name)).collect();
            let listed = item.files().iter().filter(|&&name| name != "table-1-board.csv");
            assert_eq!(written, listed.map(|&name| name.to_owned()).collect(), "{item:?}");
        }
    }
}
