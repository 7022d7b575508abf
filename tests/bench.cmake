# Aspic and the obvious program agree with the reference displacement of the beam.
if(TARGET bench_beam AND NOT ASPIC_SANITIZE)
  add_test(NAME bench.beam COMMAND bench_beam 7)
  set_tests_properties(bench.beam PROPERTIES TIMEOUT 300)
endif()
