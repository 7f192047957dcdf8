use strands::rod::Order;
use strands::statics::Settings;
use strands_cases::all;
#[test]
fn survey() {
    let names = std::env::var("CASES").unwrap_or_default();
    let tol: f64 = std::env::var("TOL").ok().and_then(|t| t.parse().ok()).unwrap_or(1e-11);
    for case in all().iter().filter(|case| names.split(',').any(|n| case.name.starts_with(n))) {
        let settings = Settings { tolerance: tol, restart_from_rest: false, ..Settings::default() };
        let n = std::env::var("N").ok().and_then(|t| t.parse().ok()).unwrap_or(case.elements);
        let t = std::time::Instant::now();
        let outs = case.solve(n, Order::Fourth, &settings);
        println!("== {} {:?}", case.name, t.elapsed());
        for (row, out) in case.rows.iter().zip(outs) {
            match out {
                Err(e) => println!("   {}: FAILED {e}", row.label),
                Ok(o) => {
                    let bad = o.comparisons.iter().map(|c| format!("{:.0e}", c.error)).collect::<Vec<_>>().join(" ");
                    println!("{} {}: worst {:.1e} answer {} idx {:?} known {:?} {:?} it {} imb {:.0e} [{bad}]", if o.worst() > case.tolerance { "!!" } else { "  " }, row.label, o.worst(), o.answer, o.solution.report.morse_index, row.answers[o.answer].index, o.solution.report.method, o.solution.report.iterations, o.solution.imbalance(&o.problem));
                }
            }
        }
    }
}
