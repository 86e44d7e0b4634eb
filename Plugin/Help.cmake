# Help pages for ParaView's window, from the documentation in the XML files: `help` is ON where ParaView can make them.
# It wants Qt's help module and xmlpatterns, of which distributions may install a stub.
set(help OFF)
if (PROGISO_QT)
  find_package(${_qt} QUIET COMPONENTS Help)
  find_program(qt_xmlpatterns_executable NAMES xmlpatterns-qt5 xmlpatterns
    HINTS "${Qt5_DIR}/../../../bin" "${Qt5_DIR}/../../../libexec/qt5/bin"
    DOC   "Path to xmlpatterns") # ParaView's own name for it
  mark_as_advanced(qt_xmlpatterns_executable)
  if (qt_xmlpatterns_executable AND TARGET ${_qt}::qhelpgenerator)
    execute_process(COMMAND "${qt_xmlpatterns_executable}" -version
      RESULT_VARIABLE _help_fails OUTPUT_QUIET ERROR_QUIET)
    if (NOT _help_fails)
      set(help ON)
    endif ()
  endif ()
  if (NOT help)
    message(STATUS "ProgIso: no help pages in ParaView's window: they need Qt's Help module and xmlpatterns")
  endif ()
endif ()

# ParaView's generator makes pages only of proxies of its own classes. The representation's is made of a copy of its XML
# in which it is one, and goes with the others by DOCUMENTATION_DIR.
set(help_of_representation)
if (help)
  set(_xml "${CMAKE_CURRENT_SOURCE_DIR}/Representations/ProgIsoRepresentation.xml")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${_xml}")
  file(READ "${_xml}" _text)
  set(_element ProgressiveIsosurfaceRepresentationProxy)
  string(REPLACE "<${_element} " "<Proxy label=\"Progressive Isosurface\" " _text "${_text}")
  string(REPLACE "</${_element}>" "</Proxy>" _text "${_text}")
  set(_copy "${CMAKE_CURRENT_BINARY_DIR}/ProgIsoRepresentationHelp.xml")
  file(GENERATE OUTPUT "${_copy}" CONTENT "${_text}")
  paraview_client_documentation(
    TARGET     ProgIsoRepresentationHelp
    OUTPUT_DIR "${CMAKE_CURRENT_BINARY_DIR}/representation_help"
    XMLS       "${_copy}")
  set(help_of_representation
    DOCUMENTATION_DIR          "${CMAKE_CURRENT_BINARY_DIR}/representation_help"
    DOCUMENTATION_DEPENDENCIES ProgIsoRepresentationHelp)
endif ()
