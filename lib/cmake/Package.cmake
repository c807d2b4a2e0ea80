# Installs configs, datasets and documents next to the programs, and defines the Debian package: `cpack -G DEB` in the build
# directory.
set(doc ${CMAKE_INSTALL_DATADIR}/doc/awmr)
install(DIRECTORY configs datasets DESTINATION ${CMAKE_INSTALL_DATADIR}/awmr
  PATTERN "generate.py" EXCLUDE)
install(FILES README.md CHANGELOG.md lib/THIRD_PARTY.md DESTINATION ${doc})

# Debian's file `copyright`: the licences of awmr and of awmr-pil.
file(READ LICENSE licence)
file(CONFIGURE OUTPUT copyright @ONLY CONTENT
"awmr, its library, data and pages:\n\n@licence@
awmr-pil, which links libsimavr: GNU General Public License, version 3, on Debian in
/usr/share/common-licenses/GPL-3. What is linked, and under which terms, also in static form: THIRD_PARTY.md.\n")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS LICENSE)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/copyright DESTINATION ${doc})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME awmr)
set(CPACK_PACKAGE_CONTACT "The awmr authors <awmr@localhost>")
set(CPACK_PACKAGE_FILE_NAME awmr)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "From trial CSVs and driving logs of a four-wheeled robot to a model with its uncertainty, tuned
sliding-mode gains, a validated simulation and firmware for the ATmega2560. Programs, C++ library,
example data, manual pages, completions and JSON Schemas.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
# Packages that only some uses need: `find_package(awmr)` (cmake and the libraries), `awmr pil` (the AVR compiler), the Python module
# (NumPy) and plot.py of `--figures` (Matplotlib).
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, libceres-dev, libeigen3-dev, nlohmann-json3-dev, libfmt-dev, libmuparser-dev, \
libexpected-dev, libssl-dev, libnlopt-dev, libnlopt-cxx-dev, libsqlite3-dev, libgeographiclib-dev, gcc-avr, avr-libc, python3-numpy, python3-matplotlib")
# All components, and the component `debian` with the files that only the Debian package contains.
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};awmr;ALL;/;${CMAKE_BINARY_DIR};awmr;debian;/")
if(PROJECT_IS_TOP_LEVEL)
  include(CPack)
endif()
