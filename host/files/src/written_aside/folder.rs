//! A folder that is written aside.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use super::rights::Rights;
use super::temporary::Temporary;
use super::under_way::{self, Noted};
use super::{folder_of, rename, settle, sync_folder};

/// How often a place is checked again if it changes between two checks.
const LOOKS: usize = 100;

/// A folder with a name of our own, beside the place that it is for. It is removed, with everything in it, unless it is put in
/// its place.
#[derive(Debug)]
pub struct AsideFolder {
    dir: Temporary,
    target: PathBuf,
    /// Holds the lock.
    _held: File,
    _noted: Noted,
}

/// A folder that was not put in its place.
#[derive(Debug)]
pub enum Misplaced {
    /// Something is there that may not be replaced: the reason.
    Taken(String),
    /// The system's reason.
    Io(io::Error),
}

impl From<io::Error> for Misplaced {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl AsideFolder {
    /// A folder for `target`, with the rights of what is there, or ordinary ones.
    ///
    /// # Errors
    /// The system's reason.
    pub fn new(target: &Path) -> io::Result<Self> {
        let (dir, held, noted) = under_way::folder(folder_of(target), Rights::of(target))?;
        Ok(Self { dir, target: target.to_owned(), _held: held, _noted: noted })
    }

    /// Where it is now.
    pub fn path(&self) -> &Path {
        self.dir.path()
    }

    /// Finds out, without changing anything, whether the system lets what is in the place be renamed. It does not let a mount
    /// point, for one.
    ///
    /// # Errors
    /// The system's reason.
    pub fn try_place(&self) -> io::Result<()> {
        use io::ErrorKind::{CrossesDevices, PermissionDenied, ReadOnlyFilesystem, ResourceBusy};
        if !fs::symlink_metadata(&self.target).is_ok_and(|there| there.is_dir()) {
            return Ok(());
        }
        // A folder is never renamed to one that has something in it. What may not be renamed at all is refused before that.
        let something = self.path().join("something");
        File::create_new(&something)?;
        let tried = fs::rename(&self.target, self.path());
        fs::remove_file(something)?;
        let refusals = [CrossesDevices, PermissionDenied, ReadOnlyFilesystem, ResourceBusy];
        match tried {
            Err(error) if refusals.contains(&error.kind()) => Err(error),
            _ => Ok(()),
        }
    }

    /// Renames it into its place. What is there is removed, unless `foreign` returns a reason why it may not be, or cannot look.
    ///
    /// # Errors
    /// [`Misplaced`], with everything as before.
    pub fn replace(self, foreign: impl Fn(&Path) -> io::Result<Option<String>>) -> Result<(), Misplaced> {
        sync_folder(self.path())?;
        for _ in 0..LOOKS {
            match rename::to_new(self.path(), &self.target) {
                Ok(()) => {
                    self.done();
                    return Ok(());
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error.into()),
            }
            if let Some(why) = foreign(&self.target)? {
                return Err(Misplaced::Taken(why));
            }
            match rename::swap(self.path(), &self.target) {
                Ok(()) => return self.drop_earlier(foreign),
                Err(error) if error.kind() == io::ErrorKind::Unsupported => {
                    self.exchange(foreign)?;
                    self.done();
                    return Ok(());
                }
                Err(error) if error.kind() == io::ErrorKind::NotFound && self.path().exists() => {}
                Err(error) => return Err(error.into()),
            }
        }
        Err(Misplaced::Taken("it is replaced all the time".to_owned()))
    }

    /// Removes what was swapped out, unless somebody put something else there between the check and the swap.
    fn drop_earlier(self, foreign: impl Fn(&Path) -> io::Result<Option<String>>) -> Result<(), Misplaced> {
        if let Some(misplaced) = kept_by(foreign(self.path())) {
            self.bring_back()?;
            return Err(misplaced);
        }
        settle(&self.target);
        Ok(())
    }

    /// Puts what was swapped out back into its place, which ours may have left meanwhile.
    fn bring_back(self) -> io::Result<()> {
        let back =
            rename::swap(self.path(), &self.target).or_else(|_| rename::to_new(self.path(), &self.target));
        if back.is_err() {
            let _ = under_way::spare(self.path(), &self.target);
            self.dir.keep();
        }
        back
    }

    /// Swaps in three steps. What was moved out of the way comes back if it may not be replaced or ours cannot take the place.
    fn exchange(&self, foreign: impl Fn(&Path) -> io::Result<Option<String>>) -> Result<(), Misplaced> {
        let earlier = self.move_away()?;
        if let Some(misplaced) = kept_by(foreign(&earlier)) {
            rename::to_new(&earlier, &self.target)?;
            return Err(misplaced);
        }
        if let Err(refused) = rename::to_new(self.path(), &self.target) {
            // If even that fails, it stays under its other name and is never removed.
            rename::to_new(&earlier, &self.target)?;
            return Err(refused.into());
        }
        // Ours is in its place, whatever becomes of the earlier one.
        if let Err(error) = fs::remove_dir_all(&earlier) {
            tracing::warn!(path = %earlier.display(), %error, "it is replaced, and not removed; remove it");
        }
        Ok(())
    }

    /// Renames what is in the place to the name of an earlier one, under which a user finds it if this run is killed then.
    fn move_away(&self) -> io::Result<PathBuf> {
        under_way::spare(&self.target, &self.target)
    }

    fn done(self) {
        let Self { dir, target, .. } = self;
        // It has its final name by now, and must not be removed on drop.
        dir.keep();
        settle(&target);
    }
}

/// Why what a caller has looked at may not be removed; none if it may be.
fn kept_by(looked: io::Result<Option<String>>) -> Option<Misplaced> {
    looked.map_or_else(|error| Some(error.into()), |why| why.map(Misplaced::Taken))
}

#[cfg(test)]
mod tests {
    use tempfile::TempDir;

    use super::*;

    fn text(folder: &Path) -> String {
        fs::read_to_string(folder.join("text")).unwrap()
    }

    /// A folder aside for `target`, with a text in it.
    fn aside(target: &Path, text: &str) -> AsideFolder {
        let aside = AsideFolder::new(target).unwrap();
        fs::write(aside.path().join("text"), text).unwrap();
        aside
    }

    /// Puts a folder with a text in it at `target`.
    fn put(target: &Path, text: &str) {
        aside(target, text).replace(|_| Ok(None)).unwrap();
    }

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn what_is_there_is_replaced_whole_or_not_at_all() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        put(&target, "first");
        let kept = aside(&target, "third").replace(|_| Ok(Some("it is precious".to_owned())));
        assert!(matches!(kept, Err(Misplaced::Taken(_))), "{kept:?}");
        assert_eq!((text(&target), entries(station.path())), ("first".to_owned(), 1));
        put(&target, "fourth");
        assert_eq!((text(&target), entries(station.path())), ("fourth".to_owned(), 1));
    }

    #[test]
    fn what_came_between_the_look_and_the_swap_comes_back() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        put(&target, "first");
        // The second check is of what was swapped out.
        let changed = |path: &Path| Ok((path != target).then(|| "it is precious".to_owned()));
        let kept = aside(&target, "second").replace(changed);
        assert!(matches!(kept, Err(Misplaced::Taken(_))), "{kept:?}");
        assert_eq!((text(&target), entries(station.path())), ("first".to_owned(), 1));
    }

    #[test]
    fn what_cannot_be_looked_at_after_the_swap_comes_back() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        put(&target, "first");
        let unread =
            |path: &Path| if path == target { Ok(None) } else { Err(io::ErrorKind::StorageFull.into()) };
        let kept = aside(&target, "second").replace(unread);
        assert!(matches!(&kept, Err(Misplaced::Io(error)) if error.kind() == io::ErrorKind::StorageFull));
        let kept = aside(&target, "third").exchange(unread);
        assert!(matches!(&kept, Err(Misplaced::Io(error)) if error.kind() == io::ErrorKind::StorageFull));
        assert_eq!((text(&target), entries(station.path())), ("first".to_owned(), 1));
    }

    #[test]
    fn what_came_meanwhile_is_not_removed_when_ours_has_left_its_place() {
        let station = TempDir::new().unwrap();
        let (target, moved) = (station.path().join("today"), station.path().join("moved"));
        put(&target, "first");
        let changed = |path: &Path| {
            Ok((path != target).then(|| {
                fs::rename(&target, &moved).unwrap();
                "it is precious".to_owned()
            }))
        };
        let kept = aside(&target, "second").replace(changed);
        assert!(matches!(kept, Err(Misplaced::Taken(_))), "{kept:?}");
        assert_eq!((text(&target), text(&moved)), ("first".to_owned(), "second".to_owned()));
        assert_eq!(entries(station.path()), 2);
    }

    #[test]
    fn where_folders_cannot_be_swapped_what_came_after_the_look_comes_back() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        put(&target, "first");
        let kept = aside(&target, "second").exchange(|_| Ok(Some("it is precious".to_owned())));
        assert!(matches!(kept, Err(Misplaced::Taken(_))), "{kept:?}");
        assert_eq!((text(&target), entries(station.path())), ("first".to_owned(), 1));
    }

    /// A file is no folder that could be removed.
    #[test]
    fn where_folders_cannot_be_swapped_the_new_one_stays_though_the_earlier_one_cannot_be_removed() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        fs::write(&target, "first").unwrap();
        aside(&target, "second").exchange(|_| Ok(None)).unwrap();
        assert_eq!(text(&target), "second");
        assert_eq!(fs::read_to_string(station.path().join("today.earlier")).unwrap(), "first");
    }

    #[test]
    fn where_folders_cannot_be_swapped_the_earlier_one_comes_back_when_the_new_one_is_not_taken() {
        let station = TempDir::new().unwrap();
        let target = station.path().join("today");
        put(&target, "first");
        let second = aside(&target, "second");
        second.exchange(|_| Ok(None)).unwrap();
        second.done();
        assert_eq!((text(&target), entries(station.path())), ("second".to_owned(), 1));
        let killed = aside(&target, "killed");
        let earlier = killed.move_away().unwrap();
        drop(killed);
        let _ = under_way::clear(station.path());
        assert_eq!((text(&earlier), entries(station.path())), ("second".to_owned(), 1));
        fs::rename(earlier, &target).unwrap();
        let third = aside(&target, "third");
        fs::remove_dir_all(third.path()).unwrap();
        let refused = third.exchange(|_| Ok(None));
        assert!(matches!(&refused, Err(Misplaced::Io(error)) if error.kind() == io::ErrorKind::NotFound));
        assert_eq!((text(&target), entries(station.path())), ("second".to_owned(), 1));
    }
}
