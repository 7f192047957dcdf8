//! `strands validate`.

use crate::common::{folder, strands};
use serde_json::Value;

#[test]
fn a_case_is_one_line_with_its_source_and_its_worst_comparison() {
    let run = strands(&["validate", "cantilever-end-moment"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let lines: Vec<&str> = run.out.lines().collect();
    assert_eq!(lines.len(), 3, "{}", run.out);
    assert!(
        lines[0].starts_with("case ") && lines[1].starts_with("cantilever-end-moment  Euler "),
        "{}",
        run.out
    );
    assert!(lines[1].ends_with(" ok"), "{}", lines[1]);
    assert!(
        lines[2].starts_with("1 cases, ") && lines[2].contains(" comparisons, 0 failed, "),
        "{}",
        lines[2]
    );
}

#[test]
fn every_comparison_is_printed_where_it_is_asked_for() {
    let run = strands(&["validate", "timoshenko", "end-moment", "--rows"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let (others, last) = run.out.trim_end().rsplit_once('\n').expect("lines");
    let printed = others.lines().count() - 1;
    assert!(printed > 20 && last.starts_with(&format!("2 cases, {printed} comparisons, 0 failed")), "{last}");
}

#[test]
fn the_findings_are_one_json_object() {
    let run = strands(&["validate", "steel-tip-wrench", "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let answer: Value = serde_json::from_str(&run.out).expect("one JSON value and nothing else");
    assert_eq!((&answer["cases"], &answer["failed"]), (&1.into(), &0.into()));
    let line = &answer["lines"][0];
    assert_eq!((&line["case"], &line["ok"]), (&"steel-tip-wrench".into(), &true.into()));
    assert!(line["error"].as_f64() < line["tolerance"].as_f64());
    for text in ["title", "source", "row", "quantity", "expected", "got"] {
        assert!(line[text].as_str().is_some_and(|text| !text.is_empty()), "{text}");
    }
}

#[test]
fn the_report_is_one_page_with_sources_and_slopes_and_nothing_from_elsewhere() {
    let path = folder("report").join("report.html");
    let run = strands(&["validate", "tip-wrench-01", "-o", path.to_str().expect("UTF-8")]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let page = std::fs::read_to_string(path).expect("the report");
    assert!(page.contains("Computer Graphics Forum 21:347–352, 2002"), "the source in full");
    for order in ["order 1, slope ", "order 2, slope ", "order 4, slope "] {
        assert!(page.contains(order), "{order}");
    }
    for elsewhere in ["http", "src=", "@import", "url("] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
    assert_eq!(page.matches("<details").count(), page.matches("</details>").count());
}
