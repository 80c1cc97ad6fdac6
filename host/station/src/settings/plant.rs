//! `[plant]`: where results are sent on to, and whom to trust on the way.

use std::path::{Path, PathBuf};

use toml::Spanned;

use super::read::file;
use super::text::{GreenText, PlantText};
use crate::input_error::{Fault, within};
use crate::published::PublicKey;
use crate::secret::{self, SecretError};
use crate::store::{PlantAddress, PlantAddressError};

/// The environment variable that may have the password.
pub(crate) const PASSWORD_OF_PLANT: &str = "HALFROW_PLANT_PASSWORD";
/// How many results may be unsent before lanes take nothing more.
const MOST_UNSENT: u32 = 10_000;
/// How full the disk may be, in per cent, while results are unsent.
const MOST_FILLED: u8 = 95;

/// `[plant]`
#[derive(Clone, Debug)]
pub struct PlantSettings {
    url: String,
    password_file: Option<PathBuf>,
    ca: Option<PathBuf>,
    /// Whether a verdict is shown only when the plant has it.
    pub is_green_at_plant: bool,
    /// How many results may be unsent before lanes take nothing more.
    pub most_unsent: u32,
    /// How full the disk may be, in per cent (1 to 100), before lanes take nothing more while results are unsent.
    pub most_filled: u8,
    /// The keys of those whose plans are taken.
    pub trusts: Vec<PublicKey>,
}

/// A plant that cannot be reached as the settings say.
#[derive(Debug, thiserror::Error)]
pub enum PlantSettingsError {
    /// Its address.
    #[error(transparent)]
    Address(#[from] PlantAddressError),
    /// Its password.
    #[error(transparent)]
    Secret(#[from] SecretError),
}

impl PlantSettings {
    /// What the settings say, in a file whose folder is `folder`.
    pub(super) fn of(folder: &Path, text: &PlantText) -> Result<Self, Fault> {
        let settings = Self {
            url: text.url.get_ref().clone(),
            password_file: text.password_file.as_ref().map(|name| file(folder, name)).transpose()?,
            ca: text.ca.as_ref().map(|name| file(folder, name)).transpose()?,
            is_green_at_plant: text.green == GreenText::Plant,
            most_unsent: text.most_unsent.as_ref().map_or(Ok(MOST_UNSENT), most_unsent)?,
            most_filled: text.most_filled.as_ref().map_or(Ok(MOST_FILLED), most_filled)?,
            trusts: text.trusts.iter().map(trusted).collect::<Result<_, _>>()?,
        };
        // A password is read when it is needed; all else is checked now.
        PlantAddress::new(&settings.url, None, settings.ca.as_deref()).map_err(|error| {
            match (&error, &text.ca) {
                (PlantAddressError::Trust(_), Some(ca)) => {
                    Fault::input(ca, "the file of the plant's certificates", error)
                }
                _ => Fault::input(&text.url, "the plant", error),
            }
        })?;
        Ok(settings)
    }

    /// Where the plant is, with the password from its file or from the environment.
    ///
    /// # Errors
    /// [`PlantSettingsError`]
    pub fn address(&self) -> Result<PlantAddress, PlantSettingsError> {
        let password = match &self.password_file {
            Some(path) => Some(secret::text(path)?.trim_end_matches(['\r', '\n']).to_owned()),
            None => std::env::var(PASSWORD_OF_PLANT).ok(),
        };
        Ok(PlantAddress::new(&self.url, password.as_deref(), self.ca.as_deref())?)
    }
}

fn trusted(text: &Spanned<String>) -> Result<PublicKey, Fault> {
    PublicKey::parse(text.get_ref()).map_err(|error| Fault::input(text, "a key", error))
}

fn most_unsent(text: &Spanned<u32>) -> Result<u32, Fault> {
    within(text, 1.., "with none unsent no lane could judge", "give 1 or more")
}

fn most_filled(text: &Spanned<u8>) -> Result<u8, Fault> {
    within(text, 1..=100, format!("a disk cannot be full to {} %", text.get_ref()), "give 1 to 100")
}
