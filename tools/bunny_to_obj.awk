# Turns the index.js of the npm package `bunny` into an OBJ file. It reads
#   exports.positions=[[x,y,z],...]      exports.cells=[[a,b,c],...]     with corners counted from 0.
BEGIN { RS = "]" }
/positions/ { kind = "v" }
/cells/ { kind = "f" }
{
  sub(/.*\[/, "")
  if (split($0, n, ",") != 3) next
  if (kind == "v") print "v", n[1], n[2], n[3]
  if (kind == "f") print "f", n[1] + 1, n[2] + 1, n[3] + 1
}
