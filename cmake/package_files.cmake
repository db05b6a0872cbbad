# Run by cpack on the installed tree before it is packed: the copyright and the changelog of a Debian package, and no
# compiled Python, which is compiled where it is installed.
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
execute_process(COMMAND find ${root} -depth -name __pycache__ -exec rm -r {} + COMMAND_ERROR_IS_FATAL ANY)

set(documents ${root}/share/doc/${CPACK_PACKAGE_NAME})
file(READ ${CPACK_HYBRID_SPHERE_SOURCE}/LICENSE licence)
file(READ ${CPACK_HYBRID_SPHERE_SOURCE}/src/html/three_licence.txt licence_of_three)
file(WRITE ${documents}/copyright "${licence}
simulate holds, for the pages of --html:

${licence_of_three}")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE ${documents}/changelog "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * The changes are those of CHANGELOG.rst.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
execute_process(COMMAND gzip -9n ${documents}/changelog COMMAND_ERROR_IS_FATAL ANY)
