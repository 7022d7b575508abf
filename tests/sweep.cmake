# Ensembles: studies, job lists that are killed and run again, collected results.
if(TARGET aspic_cli AND Python3_FOUND)
  add_python_tests(sweep sweep_test.py Ensemble Continued Collected Draws)
endif()
