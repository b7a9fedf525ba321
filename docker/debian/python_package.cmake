# The Debian package python3-vat: the Python package, with the catalogue of the package vat.
set(python COMPONENT python EXCLUDE_FROM_ALL)
set(modules lib/python3/dist-packages/vat)
set(documents share/doc/python3-vat)
get_target_property(files vat_python PACKAGE_FILES)
install(TARGETS vat_python LIBRARY DESTINATION ${modules} ${python})
install(FILES ${files} DESTINATION ${modules} ${python})
file(CREATE_LINK ../../../../share/vat/scenes ${PROJECT_BINARY_DIR}/debian/scenes SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/debian/scenes DESTINATION ${modules} ${python})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright DESTINATION ${documents} ${python})
install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION ${documents} ${python})

list(APPEND CPACK_COMPONENTS_ALL python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vat)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "vat (= ${PROJECT_VERSION}), python3-numpy,\
 python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor})")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "simulation of liquids, deformable and rigid bodies (Python)
The Python package vat runs particle simulations in process, with positions
as NumPy arrays, and is a client of servers, blocking or for asyncio.")
