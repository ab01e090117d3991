"""Typed functions in C that call and provide the operations of an interface, over the functions of skein/c/skein.h."""

import model
import names

from . import c_types, description

_COPIED = (model.Array,)
_POINTED = (model.Struct, model.Union)


def _name(interface, operation):
    return f"{c_types.name_of(interface)}_{operation.name.lstrip('_')}"


def _member(operation):
    """Of the struct of functions."""
    return names.plain(operation.name.lstrip("_"), {"on_close"})


def _structs(interface):
    for operation in interface.all_operations():
        yield f"{_name(interface, operation)}_in", operation.in_struct.members
        yield f"{_name(interface, operation)}_out", operation.out_struct.members


def _is_pointed(kind):
    kind = model.unaliased(kind)
    return isinstance(kind, model.Named) and isinstance(kind.decl, _POINTED)


def _parameter(member):
    kind = model.unaliased(member.type)
    if _is_pointed(kind):
        return f"const {c_types.member_type(kind)[0]}* {member.cpp_name}"
    return ("const " if isinstance(kind, _COPIED) else "") + c_types.declared_member(kind, member.cpp_name)


def _parameters(first, members, *last):
    return ", ".join([*first, *map(_parameter, members), *last])


def _filled(name, struct, members):
    """Statements that make `struct` of the parameters."""
    lines = [f"  {name} {struct};", f"  memset(&{struct}, 0, sizeof {struct});"]
    for member in members:
        target = f"{struct}.{member.cpp_name}"
        if isinstance(model.unaliased(member.type), _COPIED):
            lines.append(f"  memcpy({target}, {member.cpp_name}, sizeof {target});")
        else:
            lines.append(f"  {target} = {'*' if _is_pointed(member.type) else ''}{member.cpp_name};")
    return lines


def _functions(interface):
    """[(documentation, declaration, body)]"""
    name = c_types.name_of(interface)
    yield [f"What this program knows of {interface.idl_name}."], f"bool {name}_interface(skein_interface* out, skein_error error)", [
        f"  return skein_interface_new({name}_description, sizeof {name}_description, out, error);",
    ]  # fmt: skip
    yield ["See skein_proxy_connect()."], f"bool {name}_connect(skein_entity entity, const skein_connect_options* options, skein_proxy* out, skein_error error)", [
        "  skein_interface interface;",
        f"  if (!{name}_interface(&interface, error)) return false;",
        "  bool done = skein_proxy_connect(entity, interface, options, out, error);",
        "  skein_error none = {0};",
        "  skein_interface_free(interface, none);",
        "  return done;",
    ]  # fmt: skip
    for operation in interface.all_operations():
        yield from _calls(interface, operation)
        yield from _answers(interface, operation)
    yield from _provide(interface)


def _calls(interface, operation):
    name = _name(interface, operation)
    members, results = operation.in_struct.members, operation.out_struct.members
    filled = _filled(f"{name}_in", "in_", members)
    arguments = f'"{operation.name}", skein_struct(&in_, sizeof in_), 0'
    taken = [
        "  skein_value value;",
        "  if (!skein_result_value(*result, &value, error)) return false;",
        f"  *out = (const {name}_out*)value.data;",
        "  return true;",
    ]  # fmt: skip
    given = (f"skein_result* result, const {name}_out** out", "skein_error error")
    if operation.stream:
        yield [*operation.documentation, "See skein_proxy_stream()."], f"bool {name}({_parameters(['skein_proxy proxy'], members, 'skein_stream* stream', 'skein_error error')})", [
            *filled, f"  return skein_proxy_stream(proxy, {arguments}, NULL, stream, error);"]  # fmt: skip
        yield ["The next result, which lives until `result` is freed; NULL at the end."], f"bool {name}_next(skein_stream stream, {', '.join(given)})", [
            "  if (!skein_stream_next(stream, result, error)) return false;", "  *out = NULL;", "  if (result->id == 0) return true;", *taken]  # fmt: skip
        return
    if not results:
        yield operation.documentation, f"bool {name}({_parameters(['skein_proxy proxy'], members, 'skein_error error')})", [
            *filled, f"  return skein_proxy_call(proxy, {arguments}, NULL, error);"]  # fmt: skip
    else:
        yield [*operation.documentation, "What `out` points to lives until `result` is freed."], f"bool {name}({_parameters(['skein_proxy proxy'], members, *given)})", [
            *filled, f"  if (!skein_proxy_call(proxy, {arguments}, result, error)) return false;", *taken]  # fmt: skip
    if not operation.oneway:
        callbacks = ("const skein_call_callbacks* callbacks", "skein_call* call", "skein_error error")
        yield [f"See skein_proxy_start(); the result's data is a {name}_out."], f"bool {name}_start({_parameters(['skein_proxy proxy'], members, *callbacks)})", [
            *filled, f"  return skein_proxy_start(proxy, {arguments}, callbacks, call, error);"]  # fmt: skip


def _answers(interface, operation):
    if operation.oneway:
        return
    name = _name(interface, operation)
    filled = _filled(f"{name}_out", "out_", operation.out_struct.members)
    verb, ending = ("push", ", NULL, error") if operation.stream else ("answer", ", error")
    yield [f"See skein_reply_{verb}()."], f"bool {name}_{verb}({_parameters(['skein_reply reply'], operation.out_struct.members, 'skein_error error')})", [
        *filled, f"  return skein_reply_{verb}(reply, skein_struct(&out_, sizeof out_){ending});"]  # fmt: skip


def _provide(interface):
    name = c_types.name_of(interface)
    yield ["See skein_provider_new(); `functions` are copied, and a missing one is unimplemented."], (
        f"bool {name}_provide(skein_entity entity, const skein_service_options* options, const {name}_functions* functions, void* user, "
        "skein_provider* out, skein_error error)"
    ), [
        "  skein_service_options given;",
        "  memset(&given, 0, sizeof given);",
        "  if (options) given = *options;",
        "  given.encoding = SKEIN_STRUCT;",
        "  skein_interface interface;",
        f"  if (!{name}_interface(&interface, error)) return false;",
        f"  {name}_service* service = malloc(sizeof *service);",
        "  bool done = false;",
        "  if (service) {",
        "    service->functions = *functions;",
        "    service->user = user;",
        f"    skein_service_callbacks callbacks = {{service, {name}_on_call, {name}_on_close}};",
        "    done = skein_provider_new(entity, interface, &given, &callbacks, out, error);",
        "    if (!done) free(service);",
        "  } else {",
        '    skein_error_set(error, SKEIN_INTERNAL, "there is not enough memory");',
        "  }",
        "  skein_error none = {0};",
        "  skein_interface_free(interface, none);",
        "  return done;",
    ]  # fmt: skip


def definition(interface):
    """For the header."""
    name = c_types.name_of(interface)
    lines = []
    for struct, members in _structs(interface):
        lines += [f"typedef struct {struct} {struct};", *c_types.struct(struct, [(each.type, each.cpp_name, []) for each in members]), ""]
    lines += [f"/* {interface.idl_name} as C implements it. Arguments live until the reply has ended; see skein_service_callbacks. */",
              f"typedef struct {name}_functions {{"]  # fmt: skip
    for operation in interface.all_operations():
        lines += ["  " + line for line in c_types.documentation(operation.documentation)]
        lines.append(f"  void (*{_member(operation)})(void* user, const {_name(interface, operation)}_in* in, skein_reply reply);")
    lines += ["  void (*on_close)(void* user);", f"}} {name}_functions;", ""]
    for said, declaration, _ in _functions(interface):
        lines += [*c_types.documentation(said), declaration + ";"]
    return [*lines, ""]


def source(interface):
    name = c_types.name_of(interface)
    structs = [struct for each in interface.all_operations() for struct in (each.in_struct, each.out_struct, *each.raises)]
    declared = [each for each in description.closure(structs) if not any(each is o for op in interface.all_operations() for o in (op.in_struct, op.out_struct))]
    lines = [*c_types_bytes(f"{name}_description", description.interface_description(interface, declared)), ""]
    lines += [f"typedef struct {name}_service {{", f"  {name}_functions functions;", "  void* user;", f"}} {name}_service;", ""]
    lines += [f"static void {name}_on_call(void* user, const char* operation, const skein_value* arguments, skein_reply reply) {{",
              f"  const {name}_service* service = user;"]  # fmt: skip
    for operation in interface.all_operations():
        member = _member(operation)
        lines += [f'  if (service->functions.{member} && strcmp(operation, "{operation.name}") == 0) {{',
                  f"    service->functions.{member}(service->user, arguments->data, reply);", "    return;", "  }"]  # fmt: skip
    lines += ["  skein_error none = {0};", '  skein_reply_fail(reply, SKEIN_UNIMPLEMENTED, "its provider does not implement the operation", none);', "}", "",
              f"static void {name}_on_close(void* user) {{", f"  {name}_service* service = user;",
              "  if (service->functions.on_close) service->functions.on_close(service->user);", "  free(service);", "}", ""]  # fmt: skip
    for _, declaration, body in _functions(interface):
        lines += [declaration + " {", *body, "}", ""]
    return lines


def c_types_bytes(name, data):
    """A static array of these bytes."""
    rows = [", ".join(str(byte) for byte in data[at : at + 32]) for at in range(0, len(data), 32)]
    return [f"static const unsigned char {name}[] = {{", *(f"    {row}," for row in rows), "};"]


def exception_functions(exception):
    """[(documentation, declaration, body)]"""
    name = c_types.name_of(exception)
    yield ["See skein_reply_raise()."], f"bool {name}_raise(skein_reply reply, const {name}* members, skein_error error)", [
        f"  return skein_reply_raise(reply, {name}_TYPE, skein_struct(members, sizeof *members), error);"]  # fmt: skip
