# `cpack` in the build tree makes a package for Debian: program, library, tools, manual and scenes.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME billet)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Who builds the package vouches for it, as Debian's own tools have it.
execute_process(COMMAND git log -1 "--format=%an <%ae>" WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  OUTPUT_VARIABLE packager OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(DEFINED ENV{DEBEMAIL})
  set(packager "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
elseif(NOT packager)
  set(packager "unknown <root@localhost>")
endif()
set(CPACK_PACKAGE_CONTACT "${packager}" CACHE STRING "Maintainer of packages: name and address")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "contact, friction and impact of solids at large deformation")
set(CPACK_PACKAGE_DESCRIPTION
  "Finite elements for metal forming, press fits, rubber parts and crashes.
Bodies touch rigid tools, each other and themselves, with Coulomb friction.
Steps are static, implicit dynamic or explicit. Scenes are text files, and
results open in ParaView.

The package has the program, its library for material laws of one's own, the
tools around it, the manual and the shipped scenes.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3, openmpi-bin")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib, python3-numpy, python3-scipy, python3-paraview, paraview")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libdeal.ii-dev, libmumps-dev, nlohmann-json3-dev, g++, cmake, xdg-utils")
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
include(CPack)
