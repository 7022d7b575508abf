# The materials: name of the header in this folder, and type. A new material is one header and one line here, see
# docs/extending.md.
set(materials
  "neo_hookean NeoHookean"
  "stable_neo_hookean StableNeoHookean"
  "neo_hookean_log NeoHookeanLog"
  "neo_hookean_log_j2 NeoHookeanLogJ2"
  "neo_hookean_isochoric NeoHookeanIsochoric"
  "neo_hookean_2020 NeoHookean2020"
  "stvk Stvk"
  "corotated Corotated"
  "arap Arap"
  "linear Linear"
  "mooney_rivlin MooneyRivlin"
  "fung Fung"
  "yeoh Yeoh"
  "gent Gent"
  "ogden Ogden"
  "spline Spline"
  "neo_hookean_fibres NeoHookeanFibres"
)
