//! The plant's plans in copies of a station's folder.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

use halfrow_station::kept::{CopyError, backup, restore};
use halfrow_station::plan::Plan;
use halfrow_station::store::Folder;

use super::commands::did;
use super::made::{End, Made, Run};
use crate::common::{PLAN, untold};

fn made() -> Made {
    let mut made = Made::new();
    made.run(&Run::of("S1", End::Pass));
    made
}

/// Puts a plan with a picture into `plans`, in the form of a fetched plan. Returns its hash.
fn fetched(plans: &Path) -> String {
    let aside = plans.join("aside");
    fs::create_dir_all(aside.join("frames")).unwrap();
    fs::write(aside.join("frames/a.pgm"), [b"P5\n64 8\n4095\n".as_slice(), &[0; 1024]].concat()).unwrap();
    fs::write(aside.join("plan.toml"), PLAN.replace("builtin:noise", "frames/a.pgm")).unwrap();
    let hash = Plan::load(&aside.join("plan.toml")).unwrap().sha256;
    fs::rename(aside, plans.join(&hash)).unwrap();
    hash
}

/// Every file below `folder`, in order.
fn files(folder: &Path) -> Vec<String> {
    let (mut folders, mut found) = (vec![folder.to_owned()], Vec::new());
    while let Some(at) = folders.pop() {
        for entry in fs::read_dir(at).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path.strip_prefix(folder).unwrap().display().to_string());
            }
        }
    }
    found.sort();
    found
}

/// Otherwise, when root restores a copy, whoever can write to its share could obtain files that only root may read.
#[test]
fn a_copy_in_which_a_link_is_is_refused() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let [secret, copy, again] = ["secret", "copy", "again"].map(|name| place.path().join(name));
    fs::create_dir(&secret).unwrap();
    fs::write(secret.join("shadow"), "root").unwrap();
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let hash = fetched(&copy.join("plans"));
    for link in ["plans/evil", &format!("plans/{hash}/evil")] {
        symlink(&secret, copy.join(link)).unwrap();
        let refused = restore(&Folder::new(&copy), &again, &mut untold).unwrap_err();
        assert!(matches!(refused, CopyError::Faulty { faults: 1, .. }), "{refused:?}");
        assert!(refused.to_string().contains(&format!("{link} is neither a file nor a folder")), "{refused}");
        assert!(!again.exists());
        fs::remove_file(copy.join(link)).unwrap();
    }
    restore(&Folder::new(&copy), &again, &mut untold).unwrap();
    assert_eq!(files(&again.join("plans")), [format!("{hash}/frames/a.pgm"), format!("{hash}/plan.toml")]);
}

#[test]
fn of_plans_a_copy_has_whole_ones_and_what_holds() {
    let (made, place) = (made(), tempfile::tempdir().unwrap());
    let plans = made.folder().path().join("plans");
    let hash = fetched(&plans);
    let other = "0".repeat(64);
    fs::write(plans.join(&hash).join("shadow"), "root").unwrap();
    for folder in [&other, "loose"] {
        fs::create_dir(plans.join(folder)).unwrap();
        fs::write(plans.join(folder).join("plan.toml"), PLAN).unwrap();
    }
    symlink(plans.join(&hash), plans.join("evil")).unwrap();
    fs::write(plans.join(format!("{hash}.json")), r#"{"statement":"","signature":""}"#).unwrap();
    fs::write(plans.join(format!("{other}.json")), "root").unwrap();
    fs::write(plans.join("loose.json"), r#"{"statement":"","signature":""}"#).unwrap();
    let copy = place.path().join("copy");
    backup(&made.folder(), &copy, &mut untold).unwrap();
    let names = ["/frames/a.pgm", "/plan.toml", ".json"];
    let mut expected = names.map(|name| format!("{hash}{name}"));
    expected.sort();
    assert_eq!(files(&copy.join("plans")), expected);
    let (code, said, _) = did(&made, &["check"]);
    assert!(code == 3 && said.contains("plans/evil is neither a file nor a folder"), "{said}");
}
