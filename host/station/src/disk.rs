//! Whether a disk keeps what is written to it, which memory and other computers may not, and how much room it has.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use nix::sys::statfs::statfs;
use nix::sys::statvfs::statvfs;

/// File systems that may lose what was synced to them, by their magic numbers in statfs(2).
const REFUSED: [(i64, &str); 12] = [
    (0x0102_1994, "tmpfs, which is memory"),
    (0x8584_58F6, "ramfs, which is memory"),
    (0x6969, "NFS, which is another computer's"),
    (0x517B, "SMB, which is another computer's"),
    (0xFE53_4D42, "SMB, which is another computer's"),
    (0xFF53_4D42, "CIFS, which is another computer's"),
    (0x5346_414F, "AFS, which is another computer's"),
    (0x6B41_4653, "AFS, which is another computer's"),
    (0x7375_7245, "Coda, which is another computer's"),
    (0x00C3_6400, "Ceph, which is another computer's"),
    (0x0102_1997, "9P, which is another computer's"),
    (0x6573_5546, "FUSE, behind which anything may be"),
];
/// What containers run on. It passes syncs on to the disk below, unless it is mounted as `volatile`.
const OVERLAY: i64 = 0x794C_7630;

/// A folder that cannot be a station's.
#[derive(Debug, thiserror::Error)]
pub enum DiskError {
    /// The station's folder is not on a disk of this computer.
    #[error(
        "the folder {} is on {what}; put the station's folder on a disk of this computer, or take this one with --any-disk",
        folder.display()
    )]
    Refused {
        /// The folder.
        folder: PathBuf,
        /// The file system.
        what: &'static str,
    },
    /// The system does not say what kind of disk the station's folder is on.
    #[error("the system does not say what the folder {} is on; check its name, and who may read it", folder.display())]
    Untold {
        /// The folder.
        folder: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

/// Refuses the folder, which need not exist yet, if its file system may lose what was synced to it.
///
/// # Errors
/// [`DiskError`]
pub fn keeps(folder: &Path) -> Result<(), DiskError> {
    let is_there = |place: &&Path| place.exists();
    let place = folder.ancestors().find(is_there).unwrap_or(Path::new("."));
    let untold = |source| DiskError::Untold { folder: folder.to_owned(), source };
    let number = statfs(place).map_err(|error| untold(error.into()))?.filesystem_type().0;
    let refused = |what| Err(DiskError::Refused { folder: folder.to_owned(), what });
    if let Some((_, what)) = REFUSED.into_iter().find(|(known, _)| *known == number) {
        return refused(what);
    }
    if number == OVERLAY {
        let mounts = fs::read_to_string("/proc/self/mountinfo").map_err(untold)?;
        if is_volatile(&mounts, &place.canonicalize().map_err(untold)?) {
            return refused("an overlay that is volatile");
        }
        tracing::warn!(
            "{} is on an overlay, and goes with its container; mount a disk there",
            folder.display()
        );
    }
    Ok(())
}

/// Whether the mount that holds `place` is volatile. By proc_pid_mountinfo(5) the fifth field is the mount point, and
/// the last one has the options.
fn is_volatile(mounts: &str, place: &Path) -> bool {
    let mount = |line: &str| {
        let mut words = line.split(' ');
        let (at, how) = (unescaped(words.nth(4)?), words.next_back()?.to_owned());
        Some((at, how))
    };
    let over = mounts.lines().filter_map(mount).filter(|(at, _)| place.starts_with(at));
    // Of several mounts at the same point the last one covers the others.
    let nearest = over.max_by_key(|(at, _)| at.len());
    nearest.is_some_and(|(_, how)| how.split(',').any(|option| option == "volatile"))
}

/// A field of that file with the kernel's octal escapes undone.
fn unescaped(word: &str) -> String {
    let escapes = [("\\040", " "), ("\\011", "\t"), ("\\012", "\n"), ("\\134", "\\")];
    escapes.iter().fold(word.to_owned(), |word, (escape, letter)| word.replace(escape, letter))
}

/// The room on a disk, as `df` counts it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Room {
    /// The bytes that files have.
    used: u64,
    /// The bytes that are left to others than the superuser.
    pub(crate) free: u64,
}

impl Room {
    /// That of the disk with this folder.
    ///
    /// # Errors
    /// The system's reason.
    pub(crate) fn of(folder: &Path) -> io::Result<Self> {
        let disk = statvfs(folder)?;
        // What is reserved for the superuser counts as neither used nor free.
        let used = disk.blocks().saturating_sub(disk.blocks_free());
        let bytes = |blocks: u64| blocks.saturating_mul(disk.fragment_size());
        Ok(Self { used: bytes(used), free: bytes(disk.blocks_available()) })
    }

    /// All bytes that files can have.
    pub(crate) const fn size(&self) -> u64 {
        self.used.saturating_add(self.free)
    }

    /// How much of it is used, in per cent, rounded up; none for a disk without room for anything.
    pub(crate) fn filled(&self) -> Option<u64> {
        let percent = (100 * u128::from(self.used)).div_ceil(u128::from(self.size()).max(1));
        (self.size() > 0).then(|| u64::try_from(percent).unwrap_or(u64::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_refused_and_what_is_not_named_is_taken() {
        let refused = keeps("/dev/shm/station/data".as_ref()).unwrap_err().to_string();
        assert!(refused.contains("is on tmpfs, which is memory; put"), "{refused}");
        // procfs is at the same place on every system, whatever the sources lie on.
        keeps("/proc/not-there/data".as_ref()).unwrap();
    }

    #[test]
    fn an_overlay_is_asked_whether_it_is_volatile() {
        let mounts = "36 35 98:0 / / rw,noatime shared:1 - ext4 /dev/root rw,errors=continue\n\
                      40 36 0:32 / /a rw - overlay overlay rw,lowerdir=/l,upperdir=/u,workdir=/w,volatile\n\
                      41 40 0:33 / /a/b rw - overlay overlay rw,lowerdir=/l,upperdir=/u,workdir=/w\n\
                      42 36 0:34 / /a\\040b rw - overlay overlay rw,lowerdir=/l,upperdir=/u,workdir=/w,volatile\n";
        for (place, volatile) in
            [("/x", false), ("/a", true), ("/a/c", true), ("/a/b/c", false), ("/ab", false), ("/a b/c", true)]
        {
            assert_eq!(is_volatile(mounts, place.as_ref()), volatile, "{place}");
        }
        // What is mounted over a volatile mount covers it.
        let covered =
            format!("{mounts}43 40 0:35 / /a rw - overlay overlay rw,lowerdir=/l,upperdir=/v,workdir=/w\n");
        assert!(!is_volatile(&covered, "/a/c".as_ref()));
    }

    /// The numbers are from Linux's own include/uapi/linux/magic.h.
    #[test]
    fn what_may_lose_what_was_brought_to_the_disk_is_known_by_the_kernel_s_numbers() {
        let named =
            |number: i64| REFUSED.into_iter().find(|(known, _)| *known == number).map(|(_, what)| what);
        for (number, name) in [
            (0x0102_1994, "tmpfs"),
            (0x8584_58f6, "ramfs"),
            (0x6969, "NFS"),
            (0x517b, "SMB"),
            (0xfe53_4d42, "SMB"),
            (0xff53_4d42, "CIFS"),
            (0x5346_414f, "AFS"),
            (0x6b41_4653, "AFS"),
            (0x7375_7245, "Coda"),
            (0x00c3_6400, "Ceph"),
            (0x0102_1997, "9P"),
            (0x6573_5546, "FUSE"),
        ] {
            assert!(named(number).is_some_and(|what| what.starts_with(name)), "{name} {number:#x}");
        }
        // ext4, XFS and btrfs are taken; overlayfs is checked further.
        assert_eq!([0xef53, 0x5846_5342, 0x9123_683e, OVERLAY].map(named), [None; 4]);
        assert_eq!(OVERLAY, 0x794c_7630);
    }
}
