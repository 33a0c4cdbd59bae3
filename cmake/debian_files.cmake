# Run by cpack on the staged files: what Debian's policy wants of a package, beyond what any system needs.

set(usr ${CPACK_TEMPORARY_DIRECTORY}/usr)
set(documents ${usr}/share/doc/${CPACK_PACKAGE_NAME})
find_program(GZIP_EXECUTABLE gzip REQUIRED)

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
file(WRITE ${documents}/changelog.Debian
  "billet (${version}) unstable; urgency=medium\n\n  * Changes of the program: see changelog.gz.\n\n"
  " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
file(WRITE ${documents}/copyright
  "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
  "Upstream-Name: billet\n\n"
  "Files: *\n"
  "Copyright: 2026 the billet developers\n"
  "License: LGPL-2.1+\n"
  " This program is free software; you can redistribute it and/or modify it under the terms of the GNU Lesser\n"
  " General Public License as published by the Free Software Foundation; either version 2.1 of the License, or\n"
  " (at your option) any later version.\n"
  " .\n"
  " On Debian systems, the text of this license is in /usr/share/common-licenses/LGPL-2.1.\n")
file(REMOVE ${documents}/LICENSE) # the file above names it
file(RENAME ${documents}/CHANGELOG.md ${documents}/changelog)

file(GLOB pages ${usr}/share/man/man1/*.1)
foreach(file ${documents}/changelog.Debian ${documents}/changelog ${pages})
  execute_process(COMMAND ${GZIP_EXECUTABLE} -9 -n -f ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RPATH_REMOVE FILE ${usr}/bin/billet) # the system's libraries are in the system's folders
execute_process(COMMAND chmod -R u+rwX,go+rX,go-w ${usr} COMMAND_ERROR_IS_FATAL ANY)
