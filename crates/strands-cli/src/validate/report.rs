//! The findings as one HTML page that needs nothing from elsewhere.

use std::fmt::Write;

use strands::math::SimdLevel;

use super::Findings;
use super::convergence::Curves;
use super::line::Line;
use super::plot;
use super::table::{magnitude, verdict};

const STYLE: &str = include_str!("report.css");

/// The page: how many comparisons hold, how the error falls with the elements, then each case with its source.
pub fn html(findings: &Findings, curves: &[Curves]) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Strands: validation</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n"
    );
    out += &head(findings);
    out += &convergence(curves);
    out += "<h2>Cases</h2>\n<p class=\"soft\">Of each case the comparison that is nearest to its tolerance, or out of it; the others below \
            it. An error is the difference over the size that the case measures it by: the rod's length for places, 1 rad for \
            orientations, else the value's own size.</p>\n";
    for lines in findings.by_case() {
        out += &case(lines);
    }
    out + "</body>\n</html>\n"
}

fn head(findings: &Findings) -> String {
    let (style, says) = match findings.failed() {
        0 => ("good", "Every comparison is within its tolerance.".to_owned()),
        1 => ("bad", "One comparison is out of its tolerance.".to_owned()),
        failed => ("bad", format!("{failed} comparisons are out of their tolerances.")),
    };
    format!(
        "<h1>Validation of Strands {}</h1>\n\
         <p>Static equilibria of thin elastic rods and the loads at which they lose their stability, found by the solver with elements of order 4 and set beside reference answers: closed \
         forms, published figures, and independent computations.</p>\n\
         <p class=\"verdict {style}\">{says}</p>\n<p class=\"soft\">{}; on {} with {} instructions.</p>\n",
        env!("CARGO_PKG_VERSION"),
        findings.summary(),
        std::env::consts::ARCH,
        SimdLevel::detect().name(),
    )
}

fn convergence(curves: &[Curves]) -> String {
    if curves.is_empty() {
        return String::new();
    }
    let mut out = String::from(
        "<h2>The error falls with the number of elements</h2>\n<p class=\"soft\">The largest error of all of a row's quantities, on meshes \
         of equal elements. An order is right where its curve falls by that power: the slope is measured on the finest meshes whose error \
         is above round-off and the digits of the reference.</p>\n<div class=\"plots\">\n",
    );
    for one in curves {
        let _ = writeln!(
            out,
            "<figure><figcaption><h3>{}</h3>{}; {}</figcaption>\n{}</figure>",
            escaped(&one.case),
            escaped(&one.title),
            escaped(&one.row),
            plot::svg(one)
        );
    }
    out + "</div>\n"
}

fn case(lines: &[Line]) -> String {
    let Some(worst) = Line::worst(lines) else { return String::new() };
    let failed = lines.iter().filter(|line| !line.ok()).count();
    let (style, says) = match failed {
        0 => ("good", format!("{} ok", lines.len())),
        _ => ("bad", format!("{failed} of {} FAILED", lines.len())),
    };
    let mut out = format!(
        "<section class=\"case{}\">\n<header><h3>{} <span class=\"soft\"><code>{}</code></span></h3><p class=\"{style}\">{says}</p></header>\n\
         <p class=\"source\">{}</p>\n",
        if failed > 0 { " failed" } else { "" },
        escaped(&worst.title),
        escaped(&worst.case),
        escaped(&worst.source)
    );
    out += &table(&[worst]);
    if lines.len() > 1 {
        let _ = writeln!(out, "<details><summary>all {}</summary>", lines.len());
        out += &table(&lines.iter().collect::<Vec<_>>());
        out += "</details>\n";
    }
    out + "</section>\n"
}

fn table(lines: &[&Line]) -> String {
    let mut out = String::from(
        "<table><tr><th>row</th><th>quantity</th><th>expected</th><th>got</th><th class=\"number\">error</th>\
         <th class=\"number\">tolerance</th><th></th></tr>\n",
    );
    for line in lines {
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
             <td class=\"{}\">{}</td></tr>",
            escaped(&line.label),
            escaped(&line.quantity),
            escaped(&line.expected),
            escaped(&line.got),
            magnitude(line.error),
            magnitude(line.tolerance),
            if line.ok() { "good" } else { "bad" },
            verdict(line)
        );
    }
    out + "</table>\n"
}

/// A text for HTML, its formulas unbroken.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    text.replace(" = ", "\u{a0}=\u{a0}").replace("P L²", "P\u{a0}L²").replace("w L³", "w\u{a0}L³")
}
