//! Materials, solver settings, and the parts of a scene that a static solve does not use.

use crate::document::{Document, KeyPath};
use crate::error::SceneError;
use crate::file::{
    DynamicsFile, IntegratorName, JacobianName, MaterialFile, MethodName, SceneFile, SchemeName, SolverFile,
};
use indexmap::IndexMap;
use strands::rod::{Material, Order};
use strands::statics::{Jacobian, Method, Scheme, Settings};

/// The materials by name.
pub(super) fn materials<'a>(
    document: &Document,
    file: &'a SceneFile,
) -> Result<IndexMap<&'a str, Material>, SceneError> {
    let table = KeyPath::of("materials");
    file.materials
        .iter()
        .map(|(name, written)| Ok((name.as_str(), material(document, &table.key(name), written)?)))
        .collect()
}

fn material(document: &Document, path: &KeyPath, written: &MaterialFile) -> Result<Material, SceneError> {
    let youngs_modulus = document.positive(&path.key("youngs_modulus"), written.youngs_modulus)?;
    let density = document.not_negative(&path.key("density"), written.density)?;
    if let Some(damping) = written.damping {
        document.not_negative(&path.key("damping"), damping)?;
    }
    let shear_modulus = match (written.poisson_ratio, written.shear_modulus) {
        (Some(ratio), None) => {
            let possible = ratio > -1.0 && ratio <= 0.5;
            document.require(
                &path.key("poisson_ratio"),
                ratio,
                possible,
                "must be more than -1 and at most 0.5",
            )?;
            youngs_modulus / (2.0 * (1.0 + ratio))
        }
        (None, Some(modulus)) => document.positive(&path.key("shear_modulus"), modulus)?,
        (Some(_), Some(_)) => {
            let error = document
                .error(&path.key("shear_modulus"), "both `poisson_ratio` and `shear_modulus` are given");
            return Err(error.mend("keep one of the two: G = E / (2 (1 + ν))"));
        }
        (None, None) => {
            let error = document.error(path, "the material has neither `poisson_ratio` nor `shear_modulus`");
            return Err(error.mend("add `poisson_ratio = 0.3`, or `shear_modulus` in Pa"));
        }
    };
    Material::new(youngs_modulus, shear_modulus, density)
        .map_err(|error| document.error(path, error.to_string()))
}

/// The order of the discretisation.
pub(super) fn order(document: &Document, file: &SceneFile) -> Result<Order, SceneError> {
    let Some(number) = file.solver.as_ref().and_then(|solver| solver.order) else {
        return Ok(Order::default());
    };
    Order::from_number(number).ok_or_else(|| {
        let error =
            document.error(&KeyPath::of("solver").key("order"), format!("there is no order {number}"));
        error.mend(
            "use 2 (the default), 4 for fewer elements at the same error, or 1 for the paper's Euler scheme",
        )
    })
}

/// How to solve.
pub(super) fn solver(document: &Document, file: &SceneFile) -> Result<Settings, SceneError> {
    let table = KeyPath::of("solver");
    let default = Settings::default();
    let Some(written) = &file.solver else { return Ok(default) };
    let SolverFile { method, order, tolerance, max_iterations, jacobian, scheme } = written.clone();
    if let Some(tolerance) = tolerance {
        let small = tolerance > 0.0 && tolerance < 1.0;
        document.require(&table.key("tolerance"), tolerance, small, "must lie between 0 and 1")?;
    }
    if max_iterations == Some(0) {
        let error = document.error(&table.key("max_iterations"), "a search needs at least one iteration");
        return Err(error.mend(format!("leave it out for the default, {}", default.max_iterations)));
    }
    if scheme == Some(SchemeName::Multistep) && order == Some(4) {
        let message = "the multistep scheme does not go with order 4: it takes one strain an element, and order 4 has two";
        let error = document.error(&table.key("scheme"), message);
        return Err(error.mend("leave `scheme` out, or write `order = 2`"));
    }
    Ok(Settings {
        method: method.map_or(default.method, |method| match method {
            MethodName::Auto => Method::Auto,
            MethodName::Sweep => Method::Sweep,
            MethodName::Shooting => Method::Shooting,
            MethodName::MultipleShooting => Method::MultipleShooting,
            MethodName::Equilibrium => Method::Equilibrium,
        }),
        scheme: scheme.map_or(default.scheme, |scheme| match scheme {
            SchemeName::Element => Scheme::Element,
            SchemeName::Multistep => Scheme::Multistep,
        }),
        jacobian: jacobian.map_or(default.jacobian, |jacobian| match jacobian {
            JacobianName::Variational => Jacobian::Variational,
            JacobianName::VariationalLanes => Jacobian::VariationalLanes,
            JacobianName::FiniteDifferences => Jacobian::FiniteDifferences,
            JacobianName::FiniteDifferenceLanes => Jacobian::FiniteDifferenceLanes,
        }),
        tolerance: tolerance.unwrap_or(default.tolerance),
        max_iterations: max_iterations.unwrap_or(default.max_iterations),
        ..default
    })
}

/// Checks what is said of motion.
pub(super) fn check_motion(document: &Document, file: &SceneFile) -> Result<(), SceneError> {
    let Some(dynamics) = &file.dynamics else { return Ok(()) };
    let table = KeyPath::of("dynamics");
    let positive = [
        ("time_step", dynamics.time_step),
        ("tolerance", dynamics.tolerance),
        ("duration", dynamics.duration),
        ("output_rate", dynamics.output_rate),
    ];
    for (key, value) in positive {
        if let Some(value) = value {
            document.positive(&table.key(key), value)?;
        }
    }
    if dynamics.time_step.is_some() && dynamics.tolerance.is_some() {
        let error = document.error(&table.key("tolerance"), "both `time_step` and `tolerance` are given");
        return Err(error.mend("keep `time_step` for equal steps, or `tolerance` for steps that are chosen"));
    }
    if let Some(damping) = dynamics.mass_damping {
        document.not_negative(&table.key("mass_damping"), damping)?;
    }
    if dynamics.newton_iterations == Some(0) {
        let error = document.error(&table.key("newton_iterations"), "a step needs at least one iteration");
        return Err(error.mend("1 or 2 do for short steps; leave it out for as many as the tolerance takes"));
    }
    spectral_radius(document, &table, dynamics)
}

fn spectral_radius(document: &Document, table: &KeyPath, dynamics: &DynamicsFile) -> Result<(), SceneError> {
    let Some(radius) = dynamics.spectral_radius else { return Ok(()) };
    let place = table.key("spectral_radius");
    if dynamics.integrator != Some(IntegratorName::GeneralizedAlpha) {
        let error =
            document.error(&place, "`spectral_radius` goes with the integrator \"generalized_alpha\" only");
        return Err(error.mend("write `integrator = \"generalized_alpha\"`, or remove it"));
    }
    document.require(&place, radius, (0.0..=1.0).contains(&radius), "must lie from 0 to 1")?;
    Ok(())
}
