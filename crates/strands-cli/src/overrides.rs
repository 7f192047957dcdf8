//! Changes to a scene from the command line, made in the scene's text: so they pass the same checks as what stands in the file, and
//! what is said of them is said of a line that can be read.

use toml_edit::{DocumentMut, Item, Key, Table, Value};

use crate::args::{MethodName, Overrides};

/// The scene's text with the changes made. TOML keeps its comments and lines; JSON is written anew.
///
/// # Errors
/// Where a change is not of the form KEY=VALUE or leads through something that is no table. A scene that cannot be read at all is left as
/// it is: its parser says better what is wrong.
pub fn apply(text: &str, is_json: bool, overrides: &Overrides) -> Result<String, String> {
    let changes = changes(overrides)?;
    if changes.is_empty() && overrides.elements.is_none() {
        return Ok(text.to_owned());
    }
    apply_changes(text, is_json, &changes, overrides.elements)
}

fn apply_changes(
    text: &str,
    is_json: bool,
    changes: &[Change],
    elements: Option<usize>,
) -> Result<String, String> {
    if is_json {
        let Ok(mut scene) = serde_json::from_str(text) else {
            return Ok(text.to_owned());
        };
        in_json(&mut scene, changes, elements)?;
        return Ok(format!("{scene:#}"));
    }
    let Ok(mut scene) = text.parse::<DocumentMut>() else {
        return Ok(text.to_owned());
    };
    in_toml(&mut scene, changes, elements)?;
    Ok(scene.to_string())
}

/// The scene's text with one value changed.
///
/// # Errors
/// As [`apply`].
pub fn set(text: &str, is_json: bool, key: &[String], value: Value) -> Result<String, String> {
    apply_changes(text, is_json, &[(key.to_vec(), value)], None)
}

/// A dotted key in its parts, and the value for it.
type Change = (Vec<String>, Value);

/// The changes to single keys, those with a flag of their own first.
fn changes(overrides: &Overrides) -> Result<Vec<Change>, String> {
    let solver = |key: &str, value: Value| (vec!["solver".to_owned(), key.to_owned()], value);
    let mut changes = Vec::new();
    if let Some(method) = overrides.method {
        let name = match method {
            MethodName::Auto => "auto",
            MethodName::Sweep => "sweep",
            MethodName::Shooting => "shooting",
            MethodName::MultipleShooting => "multiple_shooting",
            MethodName::Equilibrium => "equilibrium",
        };
        changes.push(solver("method", name.into()));
    }
    if let Some(order) = &overrides.order {
        changes.push(solver("order", order.parse::<i64>().map_err(|error| error.to_string())?.into()));
    }
    if let Some(tolerance) = overrides.tolerance {
        changes.push(solver("tolerance", tolerance.into()));
    }
    for change in &overrides.set {
        let (key, value) = key_and_value(change).ok_or_else(|| {
            format!(
                "--set {change}: write KEY=VALUE, such as rods.thread.length=0.2; a name with other signs than letters, digits, - and _ \
                 stands in quotes, as in 'rods.\"my thread\".length=0.2'"
            )
        })?;
        // What is no TOML value is a word: --set solver.method=shooting needs no quotes.
        let value = value.trim().parse().unwrap_or_else(|_| Value::from(value.trim()));
        changes.push((key, value));
    }
    Ok(changes)
}

/// A change cut at the first `=` that ends a key: one in quotes may hold others, and dots. A place of an array is `supports.1` or, as messages
/// have it, `supports[1]`.
pub fn key_and_value(change: &str) -> Option<(Vec<String>, &str)> {
    change.match_indices('=').find_map(|(at, _)| {
        let key = change[..at].trim();
        let in_dots = || Key::parse(&key.replace('[', ".").replace(']', ""));
        let parts = Key::parse(key).or_else(|_| in_dots()).ok()?;
        Some((parts.iter().map(|part| part.get().to_owned()).collect(), &change[at + 1..]))
    })
}

fn in_toml(scene: &mut DocumentMut, changes: &[Change], elements: Option<usize>) -> Result<(), String> {
    if let (Some(elements), Some(rods)) = (elements, scene.get_mut("rods").and_then(Item::as_table_like_mut))
    {
        for (_, rod) in rods.iter_mut() {
            if let Some(rod) = rod.as_table_like_mut() {
                rod.remove("tolerance");
                rod.insert("elements", toml_edit::value(i64::try_from(elements).unwrap_or(i64::MAX)));
            }
        }
    }
    for (key, value) in changes {
        let (last, way) = key.split_last().ok_or("--set: no key")?;
        let mut item = scene.as_item_mut();
        for part in way {
            item = toml_child(item, part).ok_or_else(|| no_way(key, part))?;
        }
        let place = if let Some(table) = item.as_table_like_mut() {
            table.entry(last).or_insert(Item::None)
        } else {
            toml_child(item, last).ok_or_else(|| no_way(key, last))?
        };
        match place.as_value_mut() {
            // In place of a value, its comment stays.
            Some(old) => {
                let decor = old.decor().clone();
                *old = value.clone();
                *old.decor_mut() = decor;
            }
            None => *place = Item::Value(value.clone()),
        }
    }
    Ok(())
}

/// A part of a table or, by its number, of an array. A table that is missing is added.
fn toml_child<'a>(item: &'a mut Item, part: &str) -> Option<&'a mut Item> {
    if item.is_table_like() {
        return Some(item.as_table_like_mut()?.entry(part).or_insert_with(|| Item::Table(Table::new())));
    }
    // Tables of an array are no items of their own, so only what `get_mut` reaches.
    item.get_mut(part.parse::<usize>().ok()?)
}

fn in_json(scene: &mut serde_json::Value, changes: &[Change], elements: Option<usize>) -> Result<(), String> {
    use serde_json::Value as Json;
    if let (Some(elements), Some(rods)) = (elements, scene.get_mut("rods").and_then(Json::as_object_mut)) {
        for rod in rods.values_mut().filter_map(Json::as_object_mut) {
            rod.remove("tolerance");
            rod.insert("elements".to_owned(), elements.into());
        }
    }
    for (key, value) in changes {
        let mut place = &mut *scene;
        for part in key {
            place = match place {
                Json::Object(map) => map.entry(part).or_insert_with(|| Json::Object(serde_json::Map::new())),
                Json::Array(list) => part
                    .parse::<usize>()
                    .ok()
                    .and_then(|i| list.get_mut(i))
                    .ok_or_else(|| no_way(key, part))?,
                _ => return Err(no_way(key, part)),
            };
        }
        *place = json_value(value);
    }
    Ok(())
}

/// A value as JSON has it.
pub fn json_value(value: &Value) -> serde_json::Value {
    match value {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(number) => (*number.value()).into(),
        Value::Float(number) => (*number.value()).into(),
        Value::Boolean(flag) => (*flag.value()).into(),
        Value::Datetime(time) => time.value().to_string().into(),
        Value::Array(list) => list.iter().map(json_value).collect(),
        Value::InlineTable(table) => {
            let pairs = table.iter().map(|(key, value)| (key.to_owned(), json_value(value)));
            serde_json::Value::Object(pairs.collect())
        }
    }
}

fn no_way(key: &[String], part: &str) -> String {
    format!("--set {}: the scene has nothing named `{part}` that can be gone into", key.join("."))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "\
name = \"a\"  # kept

[rods.thread]
length = 0.3 # m
tolerance = 1e-3

[[rods.thread.supports]]
at = \"start\"
";

    fn set(changes: &[&str]) -> Overrides {
        Overrides { set: changes.iter().map(|text| (*text).to_owned()).collect(), ..Overrides::default() }
    }

    #[test]
    fn a_value_is_changed_in_its_place_and_a_missing_table_is_added() {
        let text = apply(SCENE, false, &set(&["rods.thread.length=0.2", "solver.method=shooting"])).unwrap();
        assert!(text.contains("length = 0.2 # m"), "{text}");
        assert!(text.contains("[solver]\nmethod = \"shooting\""), "{text}");
        assert!(text.contains("# kept"));
    }

    #[test]
    fn elements_take_the_place_of_a_tolerance() {
        let text = apply(SCENE, false, &Overrides { elements: Some(7), ..Overrides::default() }).unwrap();
        assert!(text.contains("elements = 7") && !text.contains("tolerance"), "{text}");
    }

    #[test]
    fn an_entry_of_an_array_is_reached_by_its_number() {
        let text = apply(SCENE, false, &set(&["rods.thread.supports.0.at=end"])).unwrap();
        assert!(text.contains("at = \"end\""), "{text}");
        assert!(apply(SCENE, false, &set(&["rods.thread.supports.4.at=end"])).is_err());
    }

    #[test]
    fn json_is_changed_alike() {
        let json = r#"{"rods": {"thread": {"length": 0.3, "supports": [{"at": "start"}]}}}"#;
        let changes = set(&["rods.thread.supports[0].at=end", "gravity=[0, 0, -1]"]);
        let scene: serde_json::Value = serde_json::from_str(&apply(json, true, &changes).unwrap()).unwrap();
        assert_eq!(scene["rods"]["thread"]["supports"][0]["at"], "end");
        assert_eq!(scene["gravity"][2], -1);
    }

    #[test]
    fn a_key_in_quotes_is_one_name_whatever_is_in_it() {
        for key in ["rods.\"thread\".length", " rods . 'thread' . length "] {
            let text = apply(SCENE, false, &set(&[&format!("{key}=0.2")])).unwrap();
            assert!(text.contains("length = 0.2 # m"), "{key}: {text}");
        }
        let odd = SCENE.replace("thread", "\"a.b = c\"");
        let text = apply(&odd, false, &set(&["rods.\"a.b = c\".length=0.2"])).unwrap();
        assert!(text.contains("length = 0.2 # m"), "{text}");
        let json = apply(r#"{"rods": {}}"#, true, &set(&["rods.\"a.b\".length=0.2"])).unwrap();
        let scene: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(scene["rods"]["a.b"]["length"], 0.2);
    }

    #[test]
    fn a_change_without_a_key_or_a_value_is_an_error() {
        for change in ["length", "=0.2", "rods.\"thread.length=0.2", "rods..length=0.2"] {
            let said = apply(SCENE, false, &set(&[change])).unwrap_err();
            assert!(said.contains("KEY=VALUE"), "{change}: {said}");
        }
    }
}
