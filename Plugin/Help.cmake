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
