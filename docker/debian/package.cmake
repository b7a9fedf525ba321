# The Debian package: the installed files, the service, and its configuration. `cpack` builds it.
set(debian ${CMAKE_CURRENT_LIST_DIR})
set(environment ${PROJECT_BINARY_DIR}/debian/vat.conf)
add_custom_command(OUTPUT ${environment} DEPENDS vat ${debian}/environment.sh
  COMMAND ${debian}/environment.sh $<TARGET_FILE:vat> ${environment})
add_custom_target(vat_package_files DEPENDS ${environment})
if(TARGET vat_manual)
  add_dependencies(vat_package_files vat_manual)
endif()
configure_file(${debian}/changelog.in ${PROJECT_BINARY_DIR}/debian/changelog @ONLY)

set(service COMPONENT service EXCLUDE_FROM_ALL)
install(FILES ${environment} DESTINATION /etc/vat ${service})
install(FILES ${debian}/vat.service DESTINATION /lib/systemd/system ${service})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright DESTINATION share/doc/vat ${service})
install(CODE "execute_process(COMMAND gzip -9n INPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog
  OUTPUT_FILE ${PROJECT_BINARY_DIR}/debian/changelog.gz COMMAND_ERROR_IS_FATAL ANY)" ${service})
install(FILES ${PROJECT_BINARY_DIR}/debian/changelog.gz DESTINATION share/doc/vat ${service})

set(CPACK_GENERATOR DEB)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_NAME vat)
set(CPACK_PACKAGE_CONTACT "the vat authors <vat@example.org>")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME vat)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "simulation of liquids, deformable and rigid bodies in a browser
A server that runs simulation sessions of particles and streams their frames
to a viewer in the browser. Several people can share a session. The program
also computes scenes without a server, and records them.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA
  ${debian}/postinst ${debian}/prerm ${debian}/postrm ${debian}/conffiles)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL Unspecified service)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
if(TARGET vat_python)
  include(${debian}/python_package.cmake)
endif()
include(CPack)
cpack_add_component(Unspecified GROUP program)
cpack_add_component(service GROUP program)
cpack_add_component(python GROUP python)
