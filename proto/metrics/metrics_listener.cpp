// SPDX-License-Identifier: Apache-2.0
#include "proto/metrics/metrics_listener.h"

#include <fmt/format.h>
#include <prometheus/text_serializer.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <charconv>
#include <chrono>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>

namespace skinframe::metrics {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

constexpr int kMostConnections = 32;
constexpr std::chrono::seconds kPatience{5};
constexpr std::uint32_t kLargestHeader = 8 * 1024;
constexpr char kTextFormat[] = "text/plain; version=0.0.4; charset=utf-8";

tcp::endpoint parse_address(const std::string& address) {
  const auto colon = address.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : address.substr(0, colon);
  const std::string port_text = colon == std::string::npos ? address : address.substr(colon + 1);
  if (host.size() > 1 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (host == "localhost") host = "127.0.0.1";
  unsigned short port = 0;
  const char* end = port_text.data() + port_text.size();
  const auto [at, error] = std::from_chars(port_text.data(), end, port);
  boost::system::error_code wrong;
  const auto ip = asio::ip::make_address(host, wrong);
  if (wrong || error != std::errc() || at != end || port_text.empty())
    throw std::runtime_error(
        fmt::format("\"{}\" is no address for metrics; give PORT (of 127.0.0.1), or IP:PORT", address));
  return {ip, port};
}

std::string text_of(const tcp::endpoint& endpoint) {
  const std::string ip = endpoint.address().to_string();
  return endpoint.address().is_v6() ? fmt::format("[{}]:{}", ip, endpoint.port())
                                    : fmt::format("{}:{}", ip, endpoint.port());
}

std::string all_of(const Sources& sources) {
  std::vector<prometheus::MetricFamily> families;
  for (const auto& source : sources) {
    auto more = source->Collect();
    families.insert(families.end(), std::make_move_iterator(more.begin()),
                    std::make_move_iterator(more.end()));
  }
  return prometheus::TextSerializer().Serialize(families);
}

// One request and its answer.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, const Sources& sources, std::shared_ptr<int> place)
      : stream_(std::move(socket)), sources_(sources), place_(std::move(place)) {
    parser_.header_limit(kLargestHeader);
    parser_.body_limit(0);
  }

  void start() {
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
    const auto path = request.target().substr(0, request.target().find('?'));
    response_.version(11);
    response_.keep_alive(false);
    if (!reads || path != "/metrics") {
      response_.result(reads ? http::status::not_found : http::status::method_not_allowed);
      response_.body() = "GET /metrics\n";
    } else {
      response_.set(http::field::content_type, kTextFormat);
      response_.body() = all_of(sources_);
    }
    response_.prepare_payload();
    if (request.method() == http::verb::head) response_.body().clear();
    stream_.expires_after(kPatience);
    http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code, std::size_t) {
      beast::error_code ignored;  // it has the answer, or is gone
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  const Sources& sources_;
  const std::shared_ptr<int> place_;  // among the connections
  beast::flat_buffer buffer_{kLargestHeader};
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> response_;
};

}  // namespace

struct MetricsListener::Service {
  Sources sources;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  const std::shared_ptr<int> places =
      std::make_shared<int>(0);  // its holders, but for this one, are connections
  std::thread thread;

  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && places.use_count() <= kMostConnections)
        std::make_shared<Session>(std::move(socket), sources, places)->start();
      accept();
    });
  }
};

MetricsListener::MetricsListener(const std::string& address, Sources sources)
    : service_(std::make_unique<Service>()) {
  const tcp::endpoint endpoint = parse_address(address);
  service_->sources = std::move(sources);
  try {
    service_->acceptor.open(endpoint.protocol());
    service_->acceptor.set_option(tcp::acceptor::reuse_address(true));
    service_->acceptor.bind(endpoint);
    service_->acceptor.listen();
    address_ = text_of(service_->acceptor.local_endpoint());
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error(
        fmt::format("cannot listen on {} for metrics: {}", address, error.code().message()));
  }
  service_->accept();
  service_->thread = std::thread([service = service_.get()] { service->io.run(); });
}

MetricsListener::~MetricsListener() {
  service_->io.stop();
  service_->thread.join();
}

}  // namespace skinframe::metrics
