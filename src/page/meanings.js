// What the figures of the page mean, in the sentences of the documentation: beside each figure, and in the help.

/** @type {Record<string, string>} */
export const MEANINGS = {
  "Displacement U": "Positive along x, the direction of the motion of the first body.",
  "Force F": "The tangential force, positive along x. It stays below the friction limit μ F_N.",
  "Load F_N": "Positive when the bodies are pressed together.",
  "Indentation d": "How far the bodies have come together since the first touch.",
  "Contact radius a": "The bodies touch inside this radius.",
  "Half-width a": "The bodies touch between −a and a.",
  "Largest pressure p_max": "Missing where the pressure is infinite, as at a sharp edge.",
  "Gross slip from u_max": "The displacement from which the whole contact slides, and its history is erased.",
  "Gross slip at μ F_N": "The largest tangential force: the coefficient of friction times the load.",
  "Largest shear stress": "Of the present state; μ p_max is friction times the largest pressure.",
  "Slip history": "The turning points that the contact remembers. A move beyond one closes its loop and erases it.",
  "Electrical conductance": "Of the constriction alone, and the resistance that it is. Films of oxide resist besides.",
  "Thermal conductance": "Of the constriction alone: heat flow over the difference of temperature of the bodies.",
  "Friction work W": "The work that friction has dissipated so far. It only grows.",
  "Measured friction μ": "From the last measured cycle of the bench that the contact follows, with its interval.",
  "Middle of the stick zone e": "A bulk stress shifts the stick zone off the middle.",
  "Amplitude U_0": "Half the distance of the turning points of the displacement.",
  "Friction work of a cycle": "The area of the loop of a steady cycle.",
  "Secant stiffness": "Force amplitude over displacement amplitude of a steady cycle.",
  "Loss factor": "Friction work of a cycle over 2π times the largest stored energy.",
  "Sliding ratio": "Displacement at zero force over the amplitude.",
  "Load that damps most": "The normal force at which a cycle of this amplitude dissipates most.",
  "Wear ends at a contact radius of": "At a held indentation: the disc inside it never slips and keeps its shape.",
  "Remains, of μ p_max": "The largest shear stress that remains, over friction times the largest pressure.",
  "Error of forces, of μ F_N": "The estimated error of any force so far, over the friction limit.",
  "Stiffer by coupling, at most":
    "Unlike bodies shear each other as they are pressed together, which is neglected: the normal stiffness may be so much larger.",
  "Error of stresses, of μ p_max": "The estimated error of a shear stress, over friction times the largest pressure.",
};
