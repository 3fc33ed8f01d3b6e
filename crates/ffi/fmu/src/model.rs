//! The model of an FMU: a contact that is made of the archive's resources, moved by its inputs, and kept as a state
//! that a master can go back to.

use std::path::Path;

use serde_json::{Value, json};
use stickslip_ffi::contact::{Held, Target};
use stickslip_ffi::exports::{SS_INDENTATION, SS_NORMAL_FORCE};

/// The variables before the parameters, in the order of modelDescription.xml: two inputs, then outputs.
const VARIABLES: usize = 7;
/// Of these the inputs: displacement, and the load.
const INPUTS: usize = 2;

/// What the resources of the archive say.
pub struct Resources {
    /// Which archive this is.
    pub guid: String,
    definition: Value,
    by_force: bool,
    /// JSON pointers into the definition.
    parameters: Vec<String>,
}

/// A state that can be copied and gone back to.
#[derive(Clone)]
pub struct State {
    inputs: [f64; INPUTS],
    parameters: Vec<f64>,
    /// The contact, and the load that it was made with.
    contact: Option<(Held, f64)>,
}

impl Resources {
    /// Reads them in the folder that a master has unpacked.
    pub fn read(folder: &Path) -> Result<Resources, String> {
        let path = folder.join("stickslip.json");
        let text = std::fs::read(&path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let document: Value = serde_json::from_slice(&text).map_err(|error| error.to_string())?;
        let texts = document["parameters"].as_array().into_iter().flatten().filter_map(Value::as_str);
        Ok(Resources {
            guid: document["guid"].as_str().unwrap_or_default().to_owned(),
            by_force: document["load"] == "normal_force",
            parameters: texts.map(str::to_owned).collect(),
            definition: document["definition"].clone(),
        })
    }

    /// The state before the first step.
    pub fn start(&self) -> Result<State, String> {
        let number = |pointer: &String| self.definition.pointer(pointer).and_then(Value::as_f64);
        let parameters = self.parameters.iter().map(number).collect::<Option<_>>().ok_or("parameters are missing")?;
        let contact = made(&self.definition)?.state();
        let load = if self.by_force { contact.normal_force } else { contact.indentation };
        Ok(State { inputs: [0.0, load], parameters, contact: None })
    }

    /// The definition with the parameters of a state, pressed by its load.
    fn definition(&self, parameters: &[f64], load: f64) -> Value {
        let mut definition = self.definition.clone();
        for (pointer, number) in self.parameters.iter().zip(parameters) {
            if let Some(place) = definition.pointer_mut(pointer) {
                *place = json!(number);
            }
        }
        definition["preload"] = json!({ (if self.by_force { "normal_force" } else { "indentation" }): load });
        definition
    }

    /// The contact of a state, which is made when it is first needed, and moved to the displacement of the start.
    fn contact<'a>(&self, state: &'a mut State) -> Result<&'a mut Held, String> {
        let State { inputs, parameters, contact } = state;
        if contact.is_none() {
            let mut held = made(&self.definition(parameters, inputs[1]))?;
            self.advance(&mut held, *inputs)?;
            *contact = Some((held, inputs[1]));
        }
        contact.as_mut().map(|(held, _)| held).ok_or_else(String::new)
    }

    fn advance(&self, held: &mut Held, [displacement, normal]: [f64; INPUTS]) -> Result<(), String> {
        let load = if self.by_force { SS_NORMAL_FORCE } else { SS_INDENTATION };
        let target = Target { load, normal, displacement: &[displacement] };
        held.step(false, target, &mut [0.0; 2]).map_err(|fault| fault.text)
    }

    /// Makes the contact, at the end of the initialization.
    pub fn initialize(&self, state: &mut State) -> Result<(), String> {
        self.contact(state).map(drop)
    }

    /// Moves the contact straight to the inputs. One that is refused has moved nothing.
    pub fn step(&self, state: &mut State) -> Result<(), String> {
        let inputs = state.inputs;
        self.advance(self.contact(state)?, inputs)
    }

    /// The value of a variable.
    pub fn get(&self, state: &mut State, reference: usize) -> Result<f64, String> {
        if reference < INPUTS {
            return Ok(state.inputs[reference]);
        }
        if reference >= VARIABLES {
            let missing = || format!("there is no variable {reference}");
            return state.parameters.get(reference - VARIABLES).copied().ok_or_else(missing);
        }
        let by_force = self.by_force;
        let now = self.contact(state)?.state();
        let load = if by_force { now.indentation } else { now.normal_force };
        let outputs = [now.force[0], load, now.dissipated_energy, now.elastic_energy, now.stick_radius];
        Ok(outputs[reference - INPUTS])
    }

    /// Sets an input, or a parameter before the first step.
    pub fn set(&self, state: &mut State, reference: usize, value: f64, initializing: bool) -> Result<(), String> {
        let refused = || format!("variable {reference} cannot be set now");
        let place = match reference {
            0..INPUTS => &mut state.inputs[reference],
            _ if !initializing => return Err(refused()),
            _ => reference.checked_sub(VARIABLES).and_then(|at| state.parameters.get_mut(at)).ok_or_else(refused)?,
        };
        *place = value;
        if initializing {
            state.contact = None;
        }
        Ok(())
    }

    /// A state as bytes: little-endian numbers, then those of the contact.
    pub fn serialize(&self, state: &State) -> Vec<u8> {
        let load = state.contact.as_ref().map_or(f64::NAN, |(_, load)| *load);
        let numbers = state.inputs.iter().chain(&state.parameters).chain([&load]);
        let mut bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
        bytes.extend(state.contact.iter().flat_map(|(held, _)| held.pack()));
        bytes
    }

    /// The state of such bytes.
    pub fn deserialize(&self, bytes: &[u8]) -> Result<State, String> {
        let wrong = || "these bytes are no state of this FMU".to_owned();
        let count = INPUTS + self.parameters.len() + 1;
        let (numbers, packed) = bytes.split_at_checked(size_of::<f64>() * count).ok_or_else(wrong)?;
        let (numbers, _) = numbers.as_chunks();
        let numbers: Vec<f64> = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        let (load, parameters) = (numbers[count - 1], numbers[INPUTS..count - 1].to_vec());
        let contact = if packed.is_empty() {
            None
        } else {
            let mut held = made(&self.definition(&parameters, load))?;
            held.unpack(packed).map_err(|fault| fault.text)?;
            Some((held, load))
        };
        Ok(State { inputs: [numbers[0], numbers[1]], parameters, contact })
    }
}

fn made(definition: &Value) -> Result<Held, String> {
    Held::line(definition.to_string().as_bytes()).map_err(|fault| fault.text)
}
