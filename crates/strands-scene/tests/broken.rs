//! Broken scenes, and what a stranger reads about each. Every file of `tests/broken` has its message as a snapshot.

use std::path::Path;
use strands_scene::Scene;

#[test]
fn every_broken_scene_has_a_message_that_says_where_and_how_to_mend_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken");
    let mut files: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".toml") || name.ends_with(".json"))
        .collect();
    files.sort();
    assert!(files.len() >= 120);
    for file in files {
        let text = std::fs::read_to_string(folder.join(&file)).unwrap();
        let error = Scene::parse(&text, &file, Some(&folder)).expect_err(&file);
        assert!(error.line() > 0 && error.column() > 0, "{file} has no place");
        assert!(!error.mends().is_empty(), "{file} has no mend");
        let message = error.to_string().replace(&folder.display().to_string(), "FOLDER");
        insta::assert_snapshot!(file.replace('.', "_"), message);
    }
}

#[test]
fn a_coloured_message_says_the_same_as_a_plain_one() {
    let error = Scene::parse("format = 1\nname = 3\n", "scene.toml", None).unwrap_err();
    let coloured = error.render(true);
    assert!(coloured.contains("\u{1b}["));
    let mut plain = String::new();
    let mut inside_escape = false;
    for c in coloured.chars() {
        match c {
            '\u{1b}' => inside_escape = true,
            'm' if inside_escape => inside_escape = false,
            _ if inside_escape => {}
            _ => plain.push(c),
        }
    }
    assert_eq!(plain, error.to_string());
    assert_eq!((error.line(), error.column(), error.key()), (2, 8, "name"));
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Scene::read(Path::new("nowhere/scene.toml")).unwrap_err();
    assert!(error.to_string().contains("nowhere/scene.toml"));
    assert_eq!(error.line(), 0);
}
